#!/bin/sh
# What pongeye-track says, and how it exits, where it cannot work. No camera and no network is needed.
set -eu
track=$(realpath "${BUILD:-build}")/bin/pongeye-track
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
failed=0

# expect STATUS SENTENCE COMMAND...: the sentence is a part of the only line on stderr.
expect()
{
	want=$1 sentence=$2
	shift 2
	status=0
	"$@" >out 2>err || status=$?
	if [ "$status" != "$want" ] || [ "$(wc -l <err)" != 1 ] || ! grep -qF -- "$sentence" err; then
		echo "FAILED: $*"
		echo "  expected exit $want and one line with: $sentence"
		echo "  got exit $status and: $(cat err)"
		failed=1
	fi
}

cat >rig.toml <<'END'
[left]
size = [640, 480]
P = [1000, 0, 320, 0, 0, 1000, 240, 0, 0, 0, 1, 0]
[right]
size = [640, 480]
P = [1000, 0, 320, -180, 0, 1000, 240, 0, 0, 0, 1, 0]
END
{ cat rig.toml; echo '[capture]'; echo 'exposre = 0.002'; } >misspelt.toml
sed 's/\[left\]/[left]\ncamera = "127.9.9.9"/; s/\[right\]/[right]\ncamera = "127.9.9.8"/' rig.toml >absent.toml
mkdir empty

expect 2 'is needed' "$track"
expect 2 'goes with --images' "$track" --rig rig.toml --fps 60
expect 1 'nowhere.toml' "$track" --rig nowhere.toml
expect 1 'names no left camera' "$track" --rig rig.toml --lcm-url memq://
expect 1 "misspelt.toml:8:1: unknown key 'exposre'" "$track" --rig misspelt.toml --lcm-url memq://
expect 1 'left camera 127.9.9.9: not found' "$track" --rig absent.toml --lcm-url memq://
expect 1 'nowhere: No such file' "$track" --rig rig.toml --images nowhere
expect 1 'empty: no pictures' "$track" --rig rig.toml --images empty
expect 1 'no provider' "$track" --rig rig.toml --lcm-url nonsense
expect 1 'is no multicast address' "$track" --rig rig.toml --lcm-url udpm://nonsense

# A network namespace of its own has no route at all.
if unshare -rn true 2>/dev/null; then
	expect 1 'ip route add 224.0.0.0/4 dev lo' unshare -rn "$track" --rig rig.toml
else
	echo "skipped: no multicast route (this system lets nobody make a network namespace)"
fi
exit $failed

#!/bin/bash
# What pongeye-track says, and how it exits, where it cannot work. No camera and no network is needed.
. "$(dirname "$0")/lib.sh"
track=$bin/pongeye-track
cd "$work" || exit 1

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
sed 's/size = /size /' rig.toml >malformed.toml
sed 's/640, 480/320, 240/' rig.toml >small.toml
mkdir empty truncated
"$bin/pongeye-simulate" --out pictures --frames 3 2>simulate.log || cat simulate.log
cp pictures/000000-*.png truncated
head -c 1000 pictures/000001-left.png >truncated/000001-left.png
cp pictures/000001-right.png truncated

check_refusal "no --rig" 2 'is needed' "$track"
check_refusal "--fps without --images" 2 'goes with --images' "$track" --rig rig.toml --fps 60
check_refusal "no rig.toml" 1 'nowhere.toml: No such file' "$track" --rig nowhere.toml
check_refusal "a malformed rig.toml, with line and column" 1 'malformed.toml:2:' "$track" --rig malformed.toml
check_refusal "a misspelt key" 1 "misspelt.toml:8:1: unknown key 'exposre'" "$track" --rig misspelt.toml --lcm-url memq://
check_refusal "no camera in rig.toml" 1 'names no left camera' "$track" --rig rig.toml --lcm-url memq://
"$track" --rig absent.toml --lcm-url memq:// --seconds 1 2>absent.log
check "a camera that is not there is waited for, which is said" bash -c "[ $? -eq 0 ] && grep -q 'left camera 127.9.9.9: not found' absent.log"
check_refusal "no folder" 1 'nowhere: No such file' "$track" --rig rig.toml --images nowhere
check_refusal "an empty folder" 1 'empty: no pictures' "$track" --rig rig.toml --images empty
check_refusal "pictures of another size" 1 'the left picture is 640 x 480, its camera in the rig 320 x 240' \
	"$track" --rig small.toml --images pictures
check_refusal "an LCM URL that is none" 1 'no provider' "$track" --rig rig.toml --lcm-url nonsense
check_refusal "an LCM address that is none" 1 'is no multicast address' "$track" --rig rig.toml --lcm-url udpm://nonsense
if [ -w /dev/full ]; then
	check_refusal "a full disk" 1 '/dev/full: cannot write: No space left on device' \
		"$track" --rig pictures/rig.toml --images pictures --output /dev/full
fi
"$track" --rig pictures/rig.toml --images truncated >truncated.log 2>&1
check "a truncated picture is named, without a crash" bash -c "[ $? -le 1 ] && grep -q 000001-left.png truncated.log"

user=()
[ "$(id -u)" -eq 0 ] || user=(--map-root-user)
if unshare --net "${user[@]}" true 2>/dev/null; then
	check_refusal "no multicast route, with the remedy" 1 'ip route add 224.0.0.0/4 dev lo' \
		unshare --net "${user[@]}" "$track" --rig rig.toml
else
	echo "skip - no multicast route (this system lets nobody make a network namespace)"
fi
finish

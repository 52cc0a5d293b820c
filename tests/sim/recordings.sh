#!/bin/bash
# Recordings: written beside the tracking, replayed to the same numbers, and read whatever has become of them.
. "$(dirname "$0")/lib.sh"
track=$bin/pongeye-track
cd "$work" || exit 1

"$bin/pongeye-simulate" --scene paper66 --flights 1 --seed 7 --out pictures 2>simulate.log || cat simulate.log
pairs=$(ls pictures/*-left.png | wc -l)
# `track` as a user would call it, apart from where the pictures come from.
from_pictures() { "$track" --rig pictures/rig.toml --images pictures "$@"; }
rows() { grep -vc '^#' "$1"; }
balls() { awk '!/^#/ && $7 != "-"' "$1" | wc -l; }

check "pictures are recorded" from_pictures --profile paper --output recorded.txt --record session.lcm
grep -q "session.lcm: $pairs pairs" check.log && ok "and counted" || { not_ok "and counted"; cat check.log; }
check "the recording is replayed, without rig.toml" "$track" --replay session.lcm --output replayed.txt
check "to the same table, bit for bit" cmp recorded.txt replayed.txt
check "which has balls" test "$(balls replayed.txt)" -gt 20
check "from a pipe as well" bash -c "'$track' --replay - --output piped.txt <session.lcm && cmp recorded.txt piped.txt"
check "with another profile where one is asked for" bash -c \
	"'$track' --replay session.lcm --profile best --output best.txt && ! cmp -s recorded.txt best.txt"
from_pictures --output whole.txt 2>/dev/null
check "as the pictures with that profile" cmp whole.txt best.txt
sed 's/\[hit\]/[hit]\n# moved/; s/^z = .*/z = 0.5/' pictures/rig.toml >moved.toml
check "with another rig where one is given" bash -c \
	"'$track' --replay session.lcm --rig moved.toml --output moved.txt && ! cmp -s recorded.txt moved.txt"
check "a recording of a replay replays to the same" bash -c \
	"'$track' --replay session.lcm --record again.lcm && '$track' --replay again.lcm --output again.txt && cmp recorded.txt again.txt"

# LCM's own tools read it.
if command -v lcm-logplayer >/dev/null; then
	timeout 60 lcm-logplayer --speed=1000 --lcm-url=file://played.lcm?mode=w session.lcm >player.log 2>&1
	check "lcm-logplayer plays it: what it publishes replays to the same" bash -c \
		"'$track' --replay played.lcm --output played.txt && cmp recorded.txt played.txt"
else
	echo "skip - lcm-logplayer is not here"
fi

# Smaller ones. Windows have the ball and what is around it; far from it their pictures are older than the camera's.
check "windows are recorded" "$track" --replay session.lcm --profile best --record windows.lcm --record-what windows
check "in less than a tenth of the space" test "$(stat -c %s windows.lcm)" -lt $((pairs * 2 * 640 * 480 / 10))
check "and replayed" "$track" --replay windows.lcm --output windows.txt
check "with a row for every pair" test "$(rows windows.txt)" -eq "$pairs"
check "to at least 99 % of the balls ($(balls windows.txt) of $(balls whole.txt))" \
	awk "BEGIN { exit !($(balls windows.txt) >= 0.99 * $(balls whole.txt) && $(balls windows.txt) <= $(balls whole.txt)) }"
# The background around a window is older than the camera's: that moves a ball by less than it is uncertain.
check "which are where they were, to 3 standard deviations" bash -c "paste -d' ' whole.txt windows.txt | awk '
	!/^#/ && \$7 != \"-\" && \$30 != \"-\" { n++; variance = \$13 ^ 2 + \$14 ^ 2 + \$15 ^ 2
		if ((\$7 - \$30) ^ 2 + (\$8 - \$31) ^ 2 + (\$9 - \$32) ^ 2 > 9 * variance) bad++ }
	END { exit !(n > 20 && !bad) }'"
check "messages alone take next to nothing" bash -c \
	"'$track' --replay session.lcm --record messages.lcm --record-what messages && [ \$(stat -c %s messages.lcm) -lt 1000000 ]"
check_refusal "and cannot be replayed" 1 'made with --record-what messages' "$track" --replay messages.lcm

# What has become of it.
head -c 20000000 session.lcm >cut.lcm
"$track" --replay cut.lcm --output cut.txt 2>cut.log
check "a recording that was cut off is replayed to there" bash -c "[ $? -eq 0 ] && [ $(rows cut.txt) -eq 32 ]"
check "with the same numbers" cmp -n "$(stat -c %s cut.txt)" recorded.txt cut.txt
check "and one sentence" test "$(grep -c 'cut off in the middle' cut.log)" -eq 1
{ head -c 5000000 session.lcm; head -c 1000 /dev/zero; tail -c +5001001 session.lcm; } >overwritten.lcm
{ head -c 5000000 session.lcm; tail -c +5400001 session.lcm; } >hole.lcm
"$track" --replay hole.lcm --output hole.txt 2>hole.log
check "one with a hole is replayed around it, all but a pair or two" bash -c \
	"[ $? -eq 0 ] && [ $((pairs - $(rows hole.txt))) -ge 1 ] && [ $((pairs - $(rows hole.txt))) -le 2 ]"
check "and says so" grep -q 'damaged: [0-9]* bytes' hole.log
check "one whose pixels were overwritten is replayed" "$track" --replay overwritten.lcm --output overwritten.txt
: >empty.lcm
check_refusal "an empty file" 1 'empty.lcm: this is no recording' "$track" --replay empty.lcm
check_refusal "a file that is no recording" 1 'this is no recording' "$track" --replay pictures/000000-left.png
check_refusal "a folder" 1 'Is a directory' "$track" --replay pictures
check_refusal "no file" 1 'nowhere.lcm: No such file' "$track" --replay nowhere.lcm
check_refusal "no folder for a recording" 1 'No such file' from_pictures --record nowhere/session.lcm
printf 'left from before' >before.lcm
sed '/^camera/d' pictures/rig.toml >nameless.toml
check_refusal "cameras that are not named" 1 'names no left camera' "$track" --rig nameless.toml --record new.lcm
check "leave no empty recording" test ! -e new.lcm
"$track" --rig nameless.toml --record before.lcm 2>/dev/null
check "nor do they cost an old one" grep -qx 'left from before' before.lcm
check_refusal "onto itself" 2 'would overwrite' "$track" --replay session.lcm --record ./session.lcm
check_refusal "pictures and a recording" 2 'one of them' from_pictures --replay session.lcm
check_refusal "--record-last without --record" 2 'goes with --record' from_pictures --record-last 3

# A full disk. `full` must leave a recording that can be read, and the table whole.
full() { # what
	grep -q 'the recording ends here' full.log && ok "$1: said" || { not_ok "$1: said"; cat full.log; }
	check "$1: exit status 1" test "$status" -eq 1
	check "$1: the tracking goes on" cmp recorded.txt full.txt
	check "$1: what was written can be replayed" "$track" --replay "$2" --output part.txt
	check "$1: it has whole pairs" test "$(rows part.txt)" -gt 10 -a "$(rows part.txt)" -lt "$pairs"
	check "$1: and is not cut off" bash -c "! grep -q 'cut off' check.log"
}
(ulimit -f 20000; "$track" --replay session.lcm --output full.txt --record limited.lcm 2>full.log)
status=$?
full "a limit on the size of files" limited.lcm
user=()
[ "$(id -u)" -eq 0 ] || user=(--map-root-user)
mkdir disk
if unshare --mount "${user[@]}" mount -t tmpfs -o size=20m tmpfs disk 2>/dev/null; then
	export track
	unshare --mount "${user[@]}" bash -c 'mount -t tmpfs -o size=20m tmpfs disk
		"$track" --replay session.lcm --output full.txt --record disk/full.lcm 2>full.log; status=$?
		cp disk/full.lcm full.lcm; exit $status'
	status=$?
	full "a full disk" full.lcm
else
	echo "skip - a full disk (this system lets nobody mount one)"
fi

# The last seconds, on a signal. The tracker reads recording after recording from a pipe; the signal comes in the midst.
mkfifo pipe
"$track" --replay pipe --record last.lcm --record-last 0.5 2>last.log &
tracker=$!
{ cat session.lcm; kill -USR1 $tracker; sleep 1; head -c 20000000 session.lcm; } >pipe
wait $tracker
check "SIGUSR1 has the last seconds written" test "$(ls last-*.lcm | wc -l)" -eq 1
check "and said" grep -qE 'the last 0\.[45][0-9]* s, 5[0-9] pairs' last.log
last=$(ls last-*.lcm)
check "they can be replayed" "$track" --replay "$last" --output last.txt
check "and are half a second" bash -c "[ $(rows last.txt) -ge 50 ] && [ $(rows last.txt) -le 58 ]"
finish

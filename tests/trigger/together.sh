#!/bin/bash
# Trigger, cameras and tracker together, each as it is shipped, in real time: pongeye-trigger drives the emulated
# microcontroller by USB, whose pulses fire pongeye-simulate's cameras, of which the right one misses every tenth;
# pongeye-track hears PONGEYE_TRIGGER. Cameras on a busy machine miss pulses of themselves: they are misses like the
# others, and of what arrived everything must be right.
. "$(dirname "$0")/../sim/lib.sh"
private_network
rate=110 pulses=1100 every=10

"$bin/pongeye-simulate" --cameras --rate $rate --trigger-line "$work/line" --miss right:$every --rig "$work/true.toml" \
	--truth "$work/truth.txt" --seed 5 2>"$work/simulate.log" &
simulator=$!
for _ in $(seq 100); do [ -S "$work/line" ] && break; sleep 0.1; done
cp "$work/true.toml" "$work/rig.toml"
printf '\n[capture]\nrate = %d\n' $rate >>"$work/rig.toml"
"$bin/pongeye-track" --rig "$work/rig.toml" --output "$work/track.txt" 2>"$work/track.log" &
tracker=$!
sleep 2
umockdev-wrapper "$BUILD/tests/trigger/live_board" "$BUILD/firmware/pongeye-trigger.elf" "$work/line" \
	"$bin/pongeye-trigger" --rate $rate --width 0.001 --count $pulses --usb >"$work/board" 2>"$work/trigger.log"
check "pongeye-trigger and its microcontroller make $pulses pulses" grep -qx "edges $pulses" "$work/board"
"$BUILD/tests/lcm_listener" 4 >"$work/heard"
kill -INT $tracker
wait $tracker
check "the tracker ends well" test $? -eq 0
kill -INT $simulator
wait $simulator
check "the simulator ends well" test $? -eq 0
sed 's/^/# /' "$work/board" "$work/trigger.log" "$work/simulate.log" "$work/track.log" "$work/heard"

# Rows of both tables side by side: a pair, and the pulse whose exposure's middle was nearest to it; and the true centres
# of the pulses before and after.
awk '
	FNR == 1 { file++ }
	file == 1 && !/^#/ { n++; time[n] = $1; row[n] = $0; centres[n] = $13 " " $14 " " $15 " " $16 }
	file == 2 && !/^#/ {
		if (!i) i = 1
		while (i < n && (time[i + 1] - $1) ^ 2 < (time[i] - $1) ^ 2) i++
		print $1 - time[i], $0, row[i], (i > 1 ? centres[i - 1] : "- - - -"), (i < n ? centres[i + 1] : "- - - -")
	}' "$work/truth.txt" "$work/track.txt" >"$work/joined"
# The first pairs may come before the first word of a pulse, and are counted then: `unheard`, for half a second at most.
# In a joined row: the times differ by $1; the tracker's frame is $3, its centres $4 to $7, its position $8 $9 $10; the
# truth begins after its 23 columns, with utime $25, frame $26, position $28 $29 $30, centres $37 to $40, and whether the
# ball is wholly in each picture, $41 $42; then come the centres of the pulse before, $47 to $50, and after, $51 to $54.
#
# A picture of another pulse shows the ball nearer to where it was then; a ball that comes straight at the camera moves by
# as little as 0.4 px a pulse, so only what is more than 1.5 px off is judged. It can be told of balls wholly in the picture;
# of one that its border cuts the visible part is located, which may be 12 px away. Where such a ball is published is
# judged by `far`, like all others.
awk -v pulses=$pulses -v every=$every '
	function apart(a, b) { return $b == "-" ? 1e9 : ($a - $b) ^ 2 + ($(a + 1) - $(b + 1)) ^ 2 }
	{
		pairs++
		late = $1 < 0 ? -$1 : $1
		if (late > latest) latest = late
		if (!last && $26 <= 55 && $3 != $26) { unheard++; next }
		if ($3 != $26) wrong_number++
		if ($3 <= last) backwards++
		for (k = last + 1; last && k < $3; k++) { absent++; if (k % every == 0) injected++ }
		if ($3 % every == 0) impossible++
		last = $3
		if ($8 == "-") next
		balls++
		if ($28 == "-") { far++; next }
		for (side = 0; side < 2; side++) {
			if (!$(41 + side)) { cut++; continue }
			compared++
			own = apart(4 + 2 * side, 37 + 2 * side)
			if (own <= 1.5 ^ 2) continue
			if (own > apart(4 + 2 * side, 47 + 2 * side) || own > apart(4 + 2 * side, 51 + 2 * side)) wrong_pair++
		}
		across = sqrt(($8 - $28) ^ 2 + ($9 - $29) ^ 2)
		# Depth: its own standard deviation is in $16.
		depth = ($10 - $30) ^ 2
		if (across > 0.05 || depth > (0.05 + 3 * $16) ^ 2) far++
	}
	END {
		printf "pairs %d\nunheard %d\nballs %d\nwrong_number %d\nbackwards %d\nimpossible %d\nwrong_pair %d\nfar %d\n",
			pairs, unheard, balls, wrong_number, backwards, impossible, wrong_pair, far
		printf "injected %d\nabsent %d\nlatest_us %d\ncompared %d\ncut %d\n", injected, absent, latest, compared, cut
	}' "$work/joined" >"$work/found"
sed 's/^/# /' "$work/found"
found() { sed -n "s/^$1 //p" "$work/found"; }
heard() { sed -n "s/^$1 //p" "$work/heard"; }
sent() { sed -n "s/.*: $1 camera: \([0-9]*\) pictures.*/\1/p" "$work/simulate.log"; }
told() { sed -n "s/.*: $1 camera: .* \([0-9]*\) triggers missed.*/\1/p" "$work/simulate.log"; }
missed() { sed -n "s/.*by the left camera \([0-9]*\), by the right \([0-9]*\).*/\\$1/p" "$work/track.log"; }
left=$(missed 1) right=$(missed 2)
lost=$(sed -n 's/.* \([0-9]*\) incomplete, \([0-9]*\) too late.*/\1 + \2/p' "$work/track.log")

check "pairs arrive ($(found pairs)), and balls ($(found balls))" test "$(found pairs)" -gt 300 -a "$(found balls)" -gt 50
check "every frame is numbered by its pulse" test "$(found wrong_number)" -eq 0 -a "$(found backwards)" -eq 0
check "no pair of a pulse that a camera missed" test "$(found impossible)" -eq 0
check "no wrong pair: each centre is nearest to its own pulse's ($(found compared) compared)" \
	test "$(found wrong_pair)" -eq 0 -a "$(found compared)" -gt 0
check "no ball is published where none is" test "$(found far)" -eq 0
check "the right camera missed as told ($(told right))" test "$(told right)" -gt 20 -a "$(told left)" -eq 0
check "missed triggers are found: right $right, of which told $(found injected)" test "$right" -ge "$(found injected)" \
	-a "$(found injected)" -gt 20
check "none is found that was none: right" test "$right" -le $((pulses - $(sent right) + $lost))
check "none is found that was none: left $left" test "$left" -le $((pulses - $(sent left) + $lost))
check "the status says the same" test "$(heard missed_left)" -eq "$left" -a "$(heard missed_right)" -eq "$right"
finish

#!/bin/bash
# The whole path as a robot meets it: simulated GigE Vision cameras, the tracker, an independent LCM subscriber. What a
# busy machine loses is not judged; of what arrived everything must be right.
. "$(dirname "$0")/lib.sh"
private_network

check "the cameras serve Aravis" "$BUILD/tests/gige_aravis"

"$bin/pongeye-simulate" --cameras --rig "$work/rig.toml" --truth "$work/truth.txt" --seed 5 2>"$work/simulate.log" &
simulator=$!
while kill -0 $simulator 2>/dev/null && ! grep -q 'cameras on' "$work/simulate.log"; do sleep 0.1; done
{ cat "$work/rig.toml"; printf '\n[capture]\nrate = 110\nexposure = 0.02\n'; } >"$work/slow.toml"
check_refusal "an exposure longer than the time between pulses" 1 "exposes for 20 ms, but at 110 Hz a picture has 9.09 ms" \
	"$bin/pongeye-track" --rig "$work/slow.toml" --output "$work/slow.txt"
"$BUILD/tests/lcm_listener" 100 >"$work/heard" &
listener=$!
"$bin/pongeye-track" --rig "$work/rig.toml" --output "$work/track.txt" --seconds 7 2>"$work/track.log"
check "the tracker ends well" test $? -eq 0
sleep 0.5 # for the last messages to be read
kill -TERM $listener
wait $listener
kill -INT $simulator
wait $simulator
check "the simulator ends well on Ctrl-C" test $? -eq 0
heard() { sed -n "s/^$1 //p" "$work/heard"; }
sed 's/^/# /' "$work/heard"

published=$(awk '!/^#/ && $7 != "-"' "$work/track.txt" | wc -l)
check "balls are heard ($(heard balls) of $published published)" test "$(heard balls)" -gt 50
check "nearly every published ball is heard" awk "BEGIN { exit !($(heard balls) >= 0.9 * $published) }"
check "predictions follow the balls" awk "BEGIN { exit !($(heard predictions) > 0.8 * $(heard balls)) }"
check "a status a second" test "$(heard statuses)" -ge 4
check "every value is sane" test "$(heard insane)" -eq 0
check "the tracker did its job on the pairs that arrived" "$bin/pongeye-bench" score --truth "$work/truth.txt" \
	--track "$work/track.txt" --rig "$work/rig.toml" --judge
# utime is the middle of the exposure: on one machine the cameras' clocks map to the truth's within a millisecond.
check "utimes are those of the exposures' middles" bash -c "
	awk '!/^#/ { print \$1 }' $work/truth.txt | sort -n >$work/true_times
	awk '!/^#/ { print \$1 }' $work/track.txt | sort -n >$work/times
	awk 'NR == FNR { t[n++] = \$1; next } { while (i < n - 1 && t[i + 1] <= \$1) i++; d = \$1 - t[i]; e = t[i + 1] - \$1
	     if (d < 0) d = -d; if (e < 0) e = -e; if (e < d) d = e; if (d > 1000) bad++; m++ } END { exit !(m > 100 && bad <= 0.01 * m) }' \
	     $work/true_times $work/times"
finish

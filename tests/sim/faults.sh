#!/bin/bash
# The tracker's word under faults: what goes wrong with a simulated camera must be reported as what it is, the tracker
# must go on and recover, and whatever is published meanwhile must be true: every ball within 5 cm of the true one (in
# depth within three of its own standard deviations more), and each of its centres nearest to where the ball was at that
# pulse. Faults come while the ball flies or bounces, or are there from the start. How many pairs a busy machine manages
# is not judged.
. "$(dirname "$0")/lib.sh"
. tests/sim/rig.sh
private_network

judged() { sed -n "s/^$1 //p" "$work/judged"; }

# Fault, pulses, words that the tracker must say (an extended regular expression; empty: none), what.
fault() {
	run "$1" "$2" 5
	awk -f tests/sim/truth.awk "$work/truth.txt" "$work/track.txt" >"$work/judged"
	local what="$1: $4"
	if [ $status -eq 0 ] && [ "$(judged false_ball)" -eq 0 ] && [ "$(judged wrong_pair)" -eq 0 ] &&
		[ "$(judged undated)" -eq 0 ] && [ "$(judged pairs)" -gt 20 ] &&
		{ [ -z "$3" ] || grep -qE -- "$3" "$work/track.log"; }; then
		ok "$what ($(judged pairs) pairs, $(judged balls) balls)"
	else
		not_ok "$what"
		echo "# status $status, wanted: $3"
		sed 's/^/# /' "$work/judged" "$work/track.log" "$work/simulate.log"
	fi
}

fault "right:die@0+1" 330 'right camera 127.0.0.2: ready' "a camera that starts late"
for moment in flight2 bounce2; do
	fault "right:die@$moment+1" 500 'right camera 127.0.0.2: it is back' "a camera that dies comes back"
	fault "left:freeze@$moment+0.5" 330 'left camera 127.0.0.1: frozen' "a frozen camera is found out"
	fault "both:truncate=0.3@$moment+0.5" 330 '[1-9][0-9]* incomplete' "pictures that end early are not used"
done
fault "right:miss@flight2+1" 400 'right camera 127.0.0.2: it answers, but sends no picture' "a loose trigger cable"
fault "left:miss=0.1,right:miss=0.1" 330 '[1-9][0-9]* without a partner' "pulses missed at random"
fault "both:lose=0.001,both:reorder=0.01" 330 '' "packets lost and overtaken are asked for again"
fault "left:drift=100,right:drift=-100,both:block=65400" 330 '' "clocks that drift, frame ids that wrap"
fault "right:offset=0.5@flight2" 440 'right camera 127.0.0.2: its clock was set' "a clock that is set"
fault "right:offset=-0.0090909@flight2" 440 'right camera 127.0.0.2: its clock was set' \
	"a clock that is set back by one period"
fault "right:miscount@flight2+0.5" 330 '; 12 of two pulses' "counters that disagree"
fault "left:held" 550 'left camera 127.0.0.1: another program controls it' "a dead client's control runs out"
finish

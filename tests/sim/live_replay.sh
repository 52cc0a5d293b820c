#!/bin/bash
# A session with cameras that miss pulses, recorded and replayed: the same table, bit for bit. Live, the cameras' threads
# look at pictures before anybody knows that they have no partner; a replay must have seen those, too.
. "$(dirname "$0")/lib.sh"
. tests/sim/rig.sh
private_network

tracker_options=(--record "$work/session.lcm")
run left:miss=0.1,right:miss=0.1 200 5
check "the session ends well" test $status -eq 0
if grep -q 'left out' "$work/track.log"; then
	echo "skip - the disk is too slow for a whole recording"
	finish
fi
check "pictures without a partner are in the recording" grep -aq PONGEYE_ALONE "$work/session.lcm"
check "it is replayed" "$bin/pongeye-track" --replay "$work/session.lcm" --output "$work/replayed.txt"
check "to the same table, bit for bit" cmp "$work/track.txt" "$work/replayed.txt"
# The exposure that the cameras have told is known as well as if the rig had said it: a flying ball leaves a streak.
exposed() { # seconds
	{ cat "$work/rig.toml"; printf '\n[locate]\nexposure = %s\n' "$1"; } >"$work/exposed.toml"
	"$bin/pongeye-track" --replay "$work/session.lcm" --rig "$work/exposed.toml" --output "$work/exposed-$1.txt"
}
check "it is replayed with the exposure stated" exposed 0.002
check "to the same table" cmp "$work/track.txt" "$work/exposed-0.002.txt"
check "it is replayed with a shorter one" exposed 0.0001
check "to another table" test -n "$(cmp "$work/track.txt" "$work/exposed-0.0001.txt")"
check "which has balls" test "$(awk '!/^#/ && $7 != "-"' "$work/replayed.txt" | wc -l)" -gt 10
finish

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
check "which has balls" test "$(awk '!/^#/ && $7 != "-"' "$work/replayed.txt" | wc -l)" -gt 10
finish

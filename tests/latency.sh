#!/bin/bash
# How long it takes from the last packet of a pair's later picture to the message on the wire, in microseconds; before
# it, what a client that only takes the pictures of the same cameras needs to have them. On a machine that has nothing
# else to do: the simulator of both cameras is there, too.
#     tests/latency.sh [SECONDS]      of each; or make latency
seconds=${LATENCY_SECONDS:-${1:-20}}
export LATENCY_SECONDS=$seconds
. "$(dirname "$0")/sim/lib.sh"
. tests/sim/rig.sh
private_network
probe=$BUILD/tests/latency_probe

echo "# what count median p99 max"
"$bin/pongeye-simulate" --cameras --rate $rate --seed 5 --rig "$work/true.toml" 2>"$work/simulate.log" &
simulator=$!
until grep -qs 'cameras on' "$work/simulate.log"; do kill -0 $simulator || exit 1; sleep 0.05; done
"$probe" "$seconds" 127.0.0.1 127.0.0.2 || exit 1
kill -INT $simulator
wait $simulator

meanwhile() { "$probe" "$seconds"; }
run both:lose=0 $((rate * (seconds + 2))) 5
echo "# load $(cut -d' ' -f1-3 /proc/loadavg); $(tail -1 "$work/track.log")"

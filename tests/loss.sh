#!/bin/bash
# Packets are lost on the way, stock socket buffers: how many pairs does that cost? With 0.1 % of the packets lost every
# fourteenth pair loses one; asked for again in time, they cost at most 0.1 % of the pairs. Counted is what the tracker
# gave up: pictures that the simulator itself was too late for, on a busy machine, are none of its doing.
#     tests/loss.sh [PULSES [PART]]      3300, 0.001; or make loss
pulses=${LOSS_PULSES:-${1:-3300}} part=${LOSS_PART:-${2:-0.001}}
export LOSS_PULSES=$pulses LOSS_PART=$part
. "$(dirname "$0")/sim/lib.sh"
. tests/sim/rig.sh
private_network
run "both:lose=$part" "$pulses" 5
lost=$(sed -n 's/.*(\([0-9]*\) without a partner, \([0-9]*\) incomplete, \([0-9]*\) too late.*/\2 \3/p' "$work/track.log" |
	awk '{ print $1 + $2 }')
pairs=$(grep -vc '^#' "$work/track.txt")
tail -1 "$work/track.log" | sed 's/^/# /'
check "of $pairs pairs $lost are lost for lost packets, at most 0.1 %" test $((1000 * lost)) -le "$pairs"
check "there are pairs" test "$pairs" -gt $((pulses / 2))
finish

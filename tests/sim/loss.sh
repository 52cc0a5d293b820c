#!/bin/bash
# Packets that are lost are asked for again: 1 % of them would cost half of the pairs. tests/loss.sh has the real bound,
# which a busy machine breaks.
. "$(dirname "$0")/lib.sh"
. tests/sim/rig.sh
private_network
rate=50
run both:lose=0.01 200 5
incomplete=$(sed -n 's/.* \([0-9]*\) incomplete.*/\1/p' "$work/track.log")
pairs=$(grep -vc '^#' "$work/track.txt")
check "of 70 packets a pair 1 % are lost: $pairs pairs, $incomplete pictures incomplete" test "$incomplete" -le 10 -a "$pairs" -gt 100
finish

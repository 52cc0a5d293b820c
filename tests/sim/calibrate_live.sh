#!/bin/bash
# Live calibration: the simulated cameras show a board that rests in one pose after another; pairs are collected, kept as
# pictures, and calibrate again to the same rig. How long a busy machine takes for it is not judged.
. "$(dirname "$0")/lib.sh"
private_network

"$bin/pongeye-simulate" --cameras --scene board --rate 20 --rig "$work/true.toml" --seed 2 2>"$work/simulate.log" &
simulator=$!
for _ in $(seq 300); do grep -q "cameras on" "$work/simulate.log" && break; sleep 0.1; done
board=(--board 9x6 --square 0.025 --no-table)
check "eight pairs are collected and calibrate" timeout 120 "$bin/pongeye-calibrate" "${board[@]}" \
	--cameras "$work/true.toml" --pairs 8 --save "$work/pictures" --output "$work/rig.toml"
sed 's/^/# /' "$work/check.log"
cp "$work/check.log" "$work/live.log"
kill -INT $simulator
wait $simulator
check "the poses that are wanted follow from the uncertainty" grep -q 'wanted next: a board .* points would be .* mm off, now ' \
	"$work/live.log"
check "every pair was kept as pictures" test "$(ls "$work"/pictures/live-0[1-8]-{left,right}.png | wc -l)" -eq 16
off=$(sed -nE 's/.*squares measure .*\(([-+.0-9]+) %\).*/\1/p' "$work/live.log")
check "squares measure what they are to 0.3 % ($off %)" awk "BEGIN { exit !($off < 0.3 && $off > -0.3) }"
check "the kept pictures calibrate again" "$bin/pongeye-calibrate" "${board[@]}" --left "$work"/pictures/*-left.png \
	--right "$work"/pictures/*-right.png --output "$work/again.toml"
check "the rig names the cameras as before" test "$(grep -c '^camera = "127.0.0.[12]"' "$work/rig.toml")" -eq 2
cameras() { sed -n '/^\[left\]/,/^\[calibration\]/p' "$1" | grep -v '^camera'; }
check "to the same cameras" test "$(cameras "$work/rig.toml")" = "$(cameras "$work/again.toml")"
check_refusal "where nothing says where the table is, it is said before pictures are taken" 2 "where is the table?" \
	"$bin/pongeye-calibrate" --board 9x6 --square 0.025 --cameras "$work/true.toml"
finish

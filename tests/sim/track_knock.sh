#!/bin/bash
# A knocked rig: the tracker notices by its own balls, and the calibration is corrected from them.
. "$(dirname "$0")/lib.sh"

# Serves in quick succession that bounce where both cameras see it.
cat >"$work/scene.toml" <<TOML
base = "rally"
[flights]
gap = 0.22
bounce = [0.6, 1.1]
TOML
"$bin/pongeye-simulate" --scene "$work/scene.toml" --flights 9 --seed 4 --out "$work/flights" 2>/dev/null

# axis, degrees: $work/knocked.toml has a right camera turned about its own x, y or z, with what only this rig has.
knock() {
	awk -v axis="$1" -v degrees="$2" '
		/^\[/ { section = $0 }
		section == "[right]" && /^P/ { open = 1; text = "" }
		open { text = text $0; if (!/\]/) next; open = 0
			gsub(/[][P=,]/, " ", text); split(text, p, " ")
			# P = K [R | t]: rows of K^-1 P, turned, and K again; K from the focal length and the middle of the picture.
			f = 8 / 0.0074; cu = 319.5; cv = 239.5; a = degrees * atan2(0, -1) / 180; c = cos(a); s = sin(a)
			for (j = 1; j <= 4; j++) { w = p[8 + j]; x = (p[j] - cu * w) / f; y = (p[4 + j] - cv * w) / f
				if (axis == "x") { t = c * y - s * w; w = s * y + c * w; y = t }
				if (axis == "y") { t = c * x + s * w; w = -s * x + c * w; x = t }
				if (axis == "z") { t = c * x - s * y; y = s * x + c * y; x = t }
				q[j] = f * x + cu * w; q[4 + j] = f * y + cv * w; q[8 + j] = w }
			printf "P = ["; for (j = 1; j <= 12; j++) printf "%.15g%s", q[j], j < 12 ? ", " : "]\n"; next }
		{ print }' "$work/flights/rig.toml" >"$work/knocked.toml"
	printf '\n[detect] # by hand\ncontrast = 8 # for this room\n' >>"$work/knocked.toml"
}
track() { # rig: $work/track.txt, $work/track.log
	"$bin/pongeye-track" --rig "$1" --images "$work/flights" --output "$work/track.txt" 2>"$work/track.log"
}
off() { # rig: how far it puts points over the table from the truth, mean, mm
	"$bin/pongeye-bench" calibration --truth "$work/flights/rig.toml" --rig "$1" | awk '!/#/ { print $2 }'
}

track "$work/flights/rig.toml"
sed 's/^/# /' "$work/track.log"
check "of the true rig the tracker says nothing" bash -c "! grep -q knocked $work/track.log"

knock x 0.05
track "$work/knocked.toml"
sed 's/^/# /' "$work/track.log"
check "a camera turned by 0.05 degrees is noticed, once" test "$(grep -c 'the rig was knocked' "$work/track.log")" -eq 1
check "and by how much: 0.94 px" awk '/knocked/ { for (i = 1; i < NF; i++) if ($(i + 1) == "px") found = $i > 0.8 && $i < 1.1 } END { exit !found }' \
	"$work/track.log"

for axis in x y z; do
	knock $axis 0.05
	before=$(off "$work/knocked.toml")
	[ $axis = x ] || track "$work/knocked.toml"
	check "0.05 degrees about $axis: --refine-from corrects" "$bin/pongeye-calibrate" --refine-from "$work/track.txt" \
		--rig "$work/knocked.toml" --knocked right --output "$work/refined.toml"
	sed 's/^/# /' "$work/check.log"
	after=$(off "$work/refined.toml")
	echo "# points over the table were $before mm off, are $after"
	# Six bounces tell a turn about z only to 0.03 degrees, and to as much as that moves points.
	expected=$(sed -n 's/.*expected 3-D error from that rotation \([0-9.]*\) mm.*/\1/p' "$work/check.log")
	check "to twice the $expected mm that it expects" at_most "$after" "$(awk "BEGIN { print 2 * $expected }")"
	[ $axis = z ] || check "and to 4 mm over the table" at_most "$after" 4
done
check "the rest of rig.toml is kept" grep -q '^contrast = 8 # for this room' "$work/refined.toml"
check "how it was refined is told" grep -qE '^rotation = \[.*\] #' "$work/refined.toml"

# The same flights as two tables, and refined twice: the second time there is nothing left to correct.
half=$(($(wc -l <"$work/track.txt") / 2))
head -n $half "$work/track.txt" >"$work/one.txt"
(head -1 "$work/track.txt"; tail -n +$((half + 1)) "$work/track.txt") >"$work/two.txt"
check "several tables are taken together" "$bin/pongeye-calibrate" --refine-from "$work/one.txt" "$work/two.txt" \
	--rig "$work/refined.toml" --output "$work/again.toml"
check "one section tells of it" test "$(grep -c '^\[refinement\]' "$work/again.toml")" -eq 1
check "a rig that was refined stays as it is" at_most "$(off "$work/again.toml")" "$(awk "BEGIN { print $after + 1 }")"
check_refusal "a recording is refused with what to do" 1 "--output FILE makes a table of it" \
	"$bin/pongeye-calibrate" --refine-from "$work/some.lcm" --rig "$work/refined.toml" --output "$work/no.toml"
finish

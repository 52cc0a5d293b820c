#!/bin/bash
# The tracker on rendered flights, and on a recorded one, scored against what is known of them.
. "$(dirname "$0")/lib.sh"

# scene, profile, options of the simulator ...: render, track, score; the tracker must do its job.
check_scene() {
	local scene=$1 profile=$2 folder=$work/$1
	shift 2
	[ -d "$folder" ] || "$bin/pongeye-simulate" --scene "$scene" --out "$folder" --seed 11 "$@" 2>/dev/null
	"$bin/pongeye-track" --rig "$folder/rig.toml" --images "$folder" --profile "$profile" \
		--output "$work/track.txt" 2>"$work/track.log" || cat "$work/track.log"
	check "$scene, profile $profile: 95 % found, under 1 false point in 1000" \
		"$bin/pongeye-bench" score --truth "$folder/truth.txt" --track "$work/track.txt" --rig "$folder/rig.toml" --judge
	"$bin/pongeye-bench" score --truth "$folder/truth.txt" --track "$work/track.txt" --rig "$folder/rig.toml" | sed 's/^/# /'
}

check_scene paper66 best --flights 6
check_scene paper66 paper

# A table's row is the brief's: these columns, in this order.
columns='# utime frame left_u left_v right_u right_v x y z vx vy vz sx sy sz hit_utime hit_x hit_y hit_z hit_sx hit_sy hit_sz hit_st'
check "the table's columns" test "$(head -1 "$work/track.txt")" = "$columns"
check "one row a pair" test "$(grep -vc '^#' "$work/track.txt")" -eq "$(ls "$work"/paper66/*-left.png | wc -l)"

# A real baseball that flies at two cameras, with people behind it; not part of the project.
flight=../shared/data/baseball-stereo/flight
if [ ! -d "$flight" ]; then
	echo "skip - the recorded flight of a baseball (its pictures are not here)"
	finish
fi
cat >"$work/baseball.toml" <<'END'
[ball]
diameter = 0.074
mass = 0.145
END
# stereo.json beside it has the matrices: one number a line.
for side in left right; do
	numbers() { tr -d ' \n' <"$flight/../stereo.json" | sed -E "s/.*\"$1\":(\[\[.*)/\1/; s/\]\].*|\],\"[a-zA-Z].*//; s/[][]+/ /g; s/ ,? ?/,/g; s/^,|,$//g"; }
	{
		echo "[$side]"
		echo "size = [640, 480]"
		echo "P = [$(numbers "P_$side")]"
		echo "distortion = [$(tr -d ' \n' <"$flight/../stereo.json" | sed -E "s/.*\"D_$side\":\[([^]]*)\].*/\1/")]"
	} >>"$work/baseball.toml"
done
check "the baseball is tracked" "$bin/pongeye-track" --rig "$work/baseball.toml" --images "$flight" --fps 75 \
	--output "$work/baseball.txt"
balls=$(awk '!/^#/ && $7 != "-"' "$work/baseball.txt" | wc -l)
check "the baseball is found in at least 38 of the 44 pairs (it is in $balls)" test "$balls" -ge 38
# Rms distance from the best quadratic in time, per axis, mm, over frames 36 to 59; normal equations of three unknowns.
awk '!/^#/ && $7 != "-" && $2 >= 36 && $2 <= 59 { t = ($2 - 47.5) / 12; n++; T[n] = t; for (k = 0; k < 3; k++) X[k, n] = $(7 + k)
	for (i = 0; i < 5; i++) S[i] += t ^ i }
	END { for (k = 0; k < 3; k++) {
		for (i = 0; i < 3; i++) { b[i] = 0; for (m = 1; m <= n; m++) b[i] += X[k, m] * T[m] ^ i; for (j = 0; j < 3; j++) A[i, j] = S[i + j] }
		for (i = 0; i < 3; i++) for (j = i + 1; j < 3; j++) { f = A[j, i] / A[i, i]; for (l = i; l < 3; l++) A[j, l] -= f * A[i, l]; b[j] -= f * b[i] }
		for (i = 2; i >= 0; i--) { c[i] = b[i]; for (j = i + 1; j < 3; j++) c[i] -= A[i, j] * c[j]; c[i] /= A[i, i] }
		e = 0; for (m = 1; m <= n; m++) { d = X[k, m] - c[0] - c[1] * T[m] - c[2] * T[m] ^ 2; e += d * d }
		printf "%.2f ", 1000 * sqrt(e / n) } print "" }' "$work/baseball.txt" >"$work/rms"
read -r across up depth <"$work/rms"
check "its points lie on quadratics: $across mm across, $up mm up, $depth mm in depth (1.5, 1.5, 5)" \
	awk "BEGIN { exit !($across <= 1.5 && $up <= 1.5 && $depth <= 5) }"
# A false point would be far from the smooth path: depth falls from frame to frame, by 0.1 to 0.4 m each.
check "no false point" awk '!/^#/ && $7 != "-" { if (n++ && (z - $9) / ($2 - f) > 0.4 || n > 1 && $9 >= z) exit 1; z = $9; f = $2 }' \
	"$work/baseball.txt"
finish

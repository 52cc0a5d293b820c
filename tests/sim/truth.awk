# What the tracker published, held against the truth: awk -f truth.awk truth.txt track.txt. A row of the tracker's belongs
# to the pulse nearest to it in time, 1 ms at most. A ball is false where there is none, or farther than 5 cm away; in
# depth three of its own standard deviations more. A centre of a ball that is wholly in the picture must be nearer to its
# own pulse's true centre than to those of the pulses before and after: else the pair is wrong. A ball that comes straight at
# the camera moves by as little as 0.4 px a pulse, so a centre that is at most 1.5 px off is right in any case.
function apart(u, v, U, V) { return U == "-" || U == "" ? 1e9 : (u - U) ^ 2 + (v - V) ^ 2 }
FNR == 1 { file++ }
/^#/ { next }
file == 1 {
	n++; time[n] = $1; x[n] = $4; y[n] = $5; z[n] = $6; seen[n, 0] = $17; seen[n, 1] = $18
	for (k = 0; k < 4; k++) c[n, k] = $(13 + k)
	next
}
{
	pairs++
	if (!i) i = 1
	while (i < n && (time[i + 1] - $1) ^ 2 < (time[i] - $1) ^ 2) i++
	if ($7 == "-") next
	balls++
	if ((time[i] - $1) ^ 2 > 1e6) { undated++; next }
	if (x[i] == "-") { false_ball++; next }
	across = sqrt(($7 - x[i]) ^ 2 + ($8 - y[i]) ^ 2)
	if (across > 0.05 || ($9 - z[i]) ^ 2 > (0.05 + 3 * $15) ^ 2) false_ball++
	if (across > farthest) farthest = across
	for (side = 0; side < 2; side++) {
		if (!seen[i, side]) continue
		own = apart($(3 + 2 * side), $(4 + 2 * side), c[i, 2 * side], c[i, 2 * side + 1])
		before = apart($(3 + 2 * side), $(4 + 2 * side), c[i - 1, 2 * side], c[i - 1, 2 * side + 1])
		after = apart($(3 + 2 * side), $(4 + 2 * side), c[i + 1, 2 * side], c[i + 1, 2 * side + 1])
		if (own <= 1.5 ^ 2 || (own <= before && own <= after)) continue
		wrong++
		printf "# pulse %d, camera %d: (%s, %s), true (%s, %s), of the pulse before (%s, %s), after (%s, %s); off by %.3f %.3f m\n", \
			i, side, $(3 + 2 * side), $(4 + 2 * side), c[i, 2 * side], c[i, 2 * side + 1], c[i - 1, 2 * side], \
			c[i - 1, 2 * side + 1], c[i + 1, 2 * side], c[i + 1, 2 * side + 1], across, $9 - z[i]
	}
}
END {
	printf "pairs %d\nballs %d\nfalse_ball %d\nwrong_pair %d\nundated %d\n", pairs, balls, false_ball, wrong, undated
	printf "farthest_across_mm %.1f\n", farthest * 1000
}

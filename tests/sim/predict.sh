#!/bin/bash
# pongeye-predict as a filter: columns, flights, noise, coefficients, and what it refuses.
. "$(dirname "$0")/lib.sh"
predict=$bin/pongeye-predict
cd "$work" || exit 1

# Two flights of a ball without air, which is easy to write down: x = 0.1 - 0.2 t, y = 0.3 + t - g t^2 / 2, z = 3 - 7 t.
awk 'BEGIN {
	print "# flight t x y z"
	for (flight = 0; flight < 2; flight++)
		for (i = 0; i < 25; i++) {
			t = i / 110
			printf "%d %.6f %.6f %.6f %.6f\n", flight, t, 0.1 - 0.2 * t, 0.3 + t - 9.80665 / 2 * t * t, 3 - 7 * t
		}
}' >flights.txt
cat >vacuum.toml <<'END'
[ball]
air_density = 0
drag = 0
drag_sigma = 0
magnus = 0
magnus_sigma = 0
END

# column: its value in the last row of out.txt
last() { awk -v name="$1" 'NR == 1 { for (i = 2; i <= NF; i++) if ($i == name) c = i - 1 } END { print $c }' out.txt; }
# column, value, tolerance
near() { awk -v a="$(last "$1")" -v b="$2" -v e="$3" 'BEGIN { exit !(a - b <= e && b - a <= e) }'; }

$predict --rig vacuum.toml --noise 0.001 --hit-plane 1 --ahead 0.1 <flights.txt >out.txt
check "a row for every point" test "$(grep -vc '^#' out.txt)" -eq 50
check "the second flight starts afresh" test "$(awk '$1 == 1 { print $3; exit }' out.txt)" -eq 1
check "the hit's time" near hit_t 0.285714 0.001
check "the hit's height" near hit_y 0.1854 0.005
check "the position ahead" near ahead_z 0.7727 0.005
$predict --rig vacuum.toml --noise 0.001 --at 0.25 <flights.txt >out.txt
check "the position at a time" near ahead_z 1.25 0.005
$predict --profile paper --hit-plane 1 <flights.txt >out.txt
check "the paper's profile predicts, too" near hit_t 0.286 0.02
check "and knows no deviations" test "$(last hit_sx)" = -

awk '$2 == "0.000000" { print "" } { print $2, $3, $4, $5 }' flights.txt | sed '1s/.*/# t x y z/' >blank.txt
check "a blank line parts flights" bash -c "$predict <blank.txt | awk '\$3 == 1' | wc -l | grep -qx 2"

$predict --fit flights.txt >fitted.toml
check "--fit writes coefficients" grep -q '^restitution_sigma = ' fitted.toml
check "which can be read back" $predict --rig fitted.toml <flights.txt
$predict --rig fitted.toml <flights.txt >out.txt
check "with the table: balls still bounce" test "$(last bounce_t)" != -
echo '[track]
noise = 0.5' >>fitted.toml
$predict --rig fitted.toml <flights.txt >doubtful.txt
check "the rig's settings count" test "$(tail -1 doubtful.txt)" != "$(tail -1 out.txt)"

printf '# t x y z\n0 0 .3 2.7\n.01 0 .3 2.6\n.01 0 .3 2.6\nnan 1 1 1\n.02 0 .3 2.5\n' | $predict >out.txt 2>skipped.txt
check "skips are counted" grep -q '2 rows were skipped' skipped.txt
check "and the rest is used" test "$(last n)" -eq 3
check_refusal "a table without z" 1 "names no column 'z'" $predict <<<'# t x y'
check_refusal "a word for a number" 1 "stdin:2: z is 'abc', not a number" $predict <<<$'# t x y z\n1 2 3 abc'
check_refusal "an unknown option" 2 "unknown option" $predict --foo
check_refusal "no such rig" 1 "nowhere.toml" $predict --rig nowhere.toml

# A million rows of one flight that never ends: bounded memory, no growing cost. Ten thousand show the trend.
awk 'BEGIN { print "# t x y z"; for (i = 0; i < 10000; i++) printf "%.4f 0 %.5f %.4f\n", i / 1000, 0.5 + 0.2 * sin(i / 50), 2 }' >endless.txt
check "a flight without end" bash -c "$predict <endless.txt | tail -1 | grep -q '^0 9.999'"
finish

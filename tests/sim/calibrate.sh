#!/bin/bash
# Calibration from pictures: rendered boards with their truth, and the stereo pairs that Debian's opencv-doc ships.
. "$(dirname "$0")/lib.sh"

# A board of A3 size before distorting lenses: the first pose lies on the table, then planes and tilted poses alternate.
cat >"$work/exact.toml" <<TOML
base = "board"
[rig]
distortion = [-0.15, 0, 0, 0, 0]
[board]
columns = 11
rows = 8
square = 0.040
planes = [0.7, 1.0, 1.3, 1.6]
plane_y = 0.2
tilted = 27
TOML
(cat "$work/exact.toml"; printf 'misplaced = 0.0002\nmisturned = 0.001\n') >"$work/wrong.toml"
planes=(--plane-z 0.7,1.0,1.3,1.6 --plane-at 0,0.2)

# folder: its pairs with planes, then those held at will, into left and right.
list_pictures() {
	local name
	left=() right=()
	for name in $(awk '!/#/ && $NF != "-" { printf "%06d ", $2 }' "$1/boards.txt") \
		$(awk '!/#/ && $NF == "-" { printf "%06d ", $2 }' "$1/boards.txt"); do
		left+=("$1/$name-left.png")
		right+=("$1/$name-right.png")
	done
}
# scene, seed, how well planes are placed: render, calibrate, and say how far points over the table are off, mm.
placed() {
	local folder=$work/$1-$2
	"$bin/pongeye-simulate" --scene "$work/$1.toml" --seed "$2" --out "$folder" 2>/dev/null
	list_pictures "$folder"
	"$bin/pongeye-calibrate" --board 11x8 --square 0.040 --left "${left[@]}" --right "${right[@]}" "${planes[@]}" \
		--plane-sigma "$3" --output "$folder.toml" >/dev/null 2>&1
	"$bin/pongeye-bench" calibration --truth "$folder/rig.toml" --rig "$folder.toml" | awk '!/#/ { print $2 }' >"$folder.off"
}
mean() { cat "$@" | awk '{ sum += $1 } END { if (NR) print sum / NR; else print "none" }'; }

for seed in 1 2 3; do
	placed wrong $seed 0.0002,0.001 &
	placed exact $seed 0.00001,0.00005
	wait $!
done
echo "# planes 0.2 mm and 1 mrad wrong: $(cat "$work"/wrong-?.off | paste -sd' ') mm off; exact: $(cat "$work"/exact-?.off | paste -sd' ') mm"
check "with planes 0.2 mm and 1 mrad wrong, points over the table are at most 0.8 mm off in the mean" \
	at_most "$(mean "$work"/wrong-?.off)" 0.8
check "with planes placed exactly, 0.6 mm" at_most "$(mean "$work"/exact-?.off)" 0.6

mv "$work/exact-3" "$work/boards"
list_pictures "$work/boards"
flat_z=$(awk '!/#/ { print $6 - 3.5 * 0.040; exit }' "$work/boards/boards.txt")

calibrate() { # options: to $work/rig.toml
	"$bin/pongeye-calibrate" --board 11x8 --square 0.040 --output "$work/rig.toml" "$@" >"$work/out" 2>"$work/err"
}
off() { # how far the rig is from the truth, mean, mm
	"$bin/pongeye-bench" calibration --truth "$work/boards/rig.toml" --rig "$work/rig.toml" | awk '!/#/ { print $2 }'
}

start=$(date +%s%N)
calibrate --left "${left[@]}" --right "${right[@]}" "${planes[@]}" --plane-sigma 0.0002,0.001 --report "$work/report.html"
check "32 pairs with planes calibrate" test $? -eq 0
echo "# $((($(date +%s%N) - start) / 1000000)) ms for 32 pairs; $(off) mm off; $(grep expected "$work/err")"
check "the report needs no other file" bash -c "! grep -qE '(src|href)=.?http' '$work/report.html'"
check "rig.toml tells how it came about" grep -q '^expected_error_mm' "$work/rig.toml"

calibrate --left "$work/boards/*-left.png" --right "$work/boards/*-right.png" --flat 000000 \
	--flat-at "0,$flat_z,0" --flat-sigma 0.0001,0.0001
echo "# boards only: $(off) mm off"
check "boards only, one of them flat on the table, are at most 2 mm off" at_most "$(off)" 2

calibrate --left "${left[@]:0:4}" --right "${right[@]:0:4}" --profile paper "${planes[@]}"
echo "# the paper's way: $(off) mm off"
check "the paper's way does not see the lens' distortion" bash -c "! awk -v o=$(off) 'BEGIN { exit !(o < 2) }'"

calibrate --left "${left[@]:0:4}" --right "${right[@]:0:4}" --flat 000000 --accept 0.01
check "what is too poor ends with 1" test $? -eq 1
"$bin/pongeye-calibrate" --board 9x6 --square 0.04 --no-table --left "${left[@]:4:3}" --right "${right[@]:4:3}" \
	--output "$work/no.toml" 2>"$work/err"
check "a wrong board size is named" grep -q "not of the size that --board says\|more corners than --board says" "$work/err"
calibrate --left "$work/boards/*-left.png" --right "$work/boards/*-right.png" --flat nowhere
check "a flat pair that is none is named" grep -q -- '--flat nowhere: no pair has this name' "$work/err"
mkdir "$work/swapped"
for picture in "$work"/boards/*-left.png; do
	name=$(basename "$picture" -left.png)
	ln -s "$picture" "$work/swapped/$name-right.png"
	ln -s "$work/boards/$name-right.png" "$work/swapped/$name-left.png"
done
calibrate --left "$work/swapped/*-left.png" --right "$work/swapped/*-right.png" --no-table
check "left and right swapped ends with 1" test $? -eq 1
check "and is said" grep -q 'are left and right swapped?' "$work/err"
calibrate --board 8x11 --left "$work/boards/*-left.png" --right "$work/boards/*-right.png" --flat 000000 --accept 1000
check "a lying board that is turned ends with 1" test $? -eq 1
check "and is said" grep -q 'not along the table (+z)' "$work/err"
"$bin/pongeye-calibrate" --board 9by6 2>/dev/null
check "a board that is none ends with 2" test $? -eq 2

# The table itself sets the frame: its corners found in a picture of the empty room, by cameras that see all of it.
cat >"$work/wide.toml" <<TOML
base = "board"
[rig]
focal = 640
behind = 1.7
above = 0.9
pitch = 14
distortion = [-0.15, 0, 0, 0, 0]
[board]
columns = 11
rows = 8
square = 0.060
planes = []
tilted = 16
TOML
sed 's/base = "board"/base = "rally"/; /^\[board\]/,$d' "$work/wide.toml" >"$work/room.toml"
"$bin/pongeye-simulate" --scene "$work/wide.toml" --seed 3 --out "$work/wide" 2>/dev/null
"$bin/pongeye-simulate" --scene "$work/room.toml" --seed 3 --frames 1 --out "$work/room" 2>/dev/null
for side in left right; do mv "$work/room/000000-$side.png" "$work/wide/table-$side.png"; done
by_table() { # options: to $work/rig.toml
	rm -f "$work/rig.toml"
	"$bin/pongeye-calibrate" --board 11x8 --square 0.060 --left "$work/wide/*-left.png" --right "$work/wide/*-right.png" \
		--table table --output "$work/rig.toml" "$@" >"$work/out" 2>"$work/err"
}
off_wide() { "$bin/pongeye-bench" calibration --truth "$work/wide/rig.toml" --rig "$work/rig.toml" | awk '!/#/ { print $2 }'; }

by_table --table-sigma 0.002 --report "$work/table.html"
check "boards, and the table's corners found in a picture, calibrate" test $? -eq 0
echo "# $(off_wide) mm off; $(grep 'corners fit' "$work/err")"
check "points over the table are at most 5 mm off in the mean" at_most "$(off_wide)" 5
check "the report shows the corners" grep -q '<h2>The table' "$work/table.html"
free=$(grep -e '--table-left' "$work/err")
by_table --table-sigma 0.002 --table-left 90,398,606,396,436,208,229,214 --table-right 34,395,548,389,417,214,196,208
check "rough clicks are refined to the same corners" awk -v a="${free#* }" -v b="$(sed -n 's/^--table-left //p' "$work/err")" \
	'BEGIN { n = split(a, p, ","); split(b, q, ","); for (i = 1; i <= n; i++) if ((p[i] - q[i]) ^ 2 > 0.01) exit 1; exit n != 8 }'
by_table --table-left 190,398,506,396,436,208,229,214
check "--table-left without --table-right ends with 2" test $? -eq 2
by_table --table-left 190,338,506,336,436,208,229,214 --table-right 34,395,548,389,417,214,196,208
check "clicks that are far off are refused" bash -c "test $? -eq 1 && grep -q 'is not seen as a white line\|do not bound a table' $work/err"
# The net's tape is a white line too, but no far end: the table's size tells.
by_table --table-left 96,393,600,391,415,235,210,235 --table-right 39,391,543,393,400,235,185,235
check "wrong lines are refused" bash -c "test $? -eq 1 && grep -qE 'miss a table of|white line|bound a table' $work/err"

# The pictures that anyone can have.
data=/usr/share/doc/opencv-doc/examples/data
if [ ! -e $data/left01.jpg ] && [ "$(id -u)" -eq 0 ]; then
	apt-get install -qq -y --no-install-recommends opencv-doc >/dev/null 2>&1
fi
if [ -e $data/left01.jpg ]; then
	"$bin/pongeye-bench" calibration --left "$data/left[0-9]*.jpg" --right "$data/right[0-9]*.jpg" --board 9x6 \
		--square 0.025 2>/dev/null >"$work/score"
	ours=$(awk '$1 == "best" { print $5 }' "$work/score")
	theirs=$(awk '$1 == "cv-stereoCalibrate" { print $5 }' "$work/score")
	echo "# opencv-doc, held out: $ours px, cv::stereoCalibrate $theirs px"
	check "opencv-doc's held-out pairs fit as well as with OpenCV, to a part in 500" \
		at_most "$ours" "$(awk -v t="$theirs" 'BEGIN { print t * 1.002 }')"
else
	echo "skip - opencv-doc is not installed and cannot be"
fi

# A recorded session with a large board; not part of the project.
data=../shared/data/baseball-stereo/calibration
if [ -d "$data" ]; then
	"$bin/pongeye-bench" calibration --left "$data/*-left.png" --right "$data/*-right.png" --board 10x7 --square 0.098552 \
		2>/dev/null >"$work/score"
	ours=$(awk '$1 == "best" { print $5 }' "$work/score")
	theirs=$(awk '$1 == "cv-stereoCalibrate" { print $5 }' "$work/score")
	echo "# recorded, held out: $ours px, cv::stereoCalibrate $theirs px"
	check "the recorded session's held-out pairs fit to 0.16 px" at_most "$ours" 0.16
	check "and no worse than with OpenCV" at_most "$ours" "$theirs"
else
	echo "skip - a recorded session with a large board (its pictures are not here)"
fi
finish

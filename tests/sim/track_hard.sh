#!/bin/bash
# The tracker where detection is hard: people behind the table, a white ball before a white wall, balls put elsewhere.
. "$(dirname "$0")/lib.sh"

# Scene, found in percent, options of the simulator ...: no false point in any.
check_hard() {
	local scene=$1 least=$2 folder=$work/hard
	shift 2
	rm -rf "$folder"
	"$bin/pongeye-simulate" --scene "$scene" --out "$folder" --seed 5 "$@" 2>/dev/null
	"$bin/pongeye-track" --rig "$folder/rig.toml" --images "$folder" --output "$work/hard.txt" 2>"$work/track.log" ||
		cat "$work/track.log"
	"$bin/pongeye-bench" score --truth "$folder/truth.txt" --track "$work/hard.txt" --rig "$folder/rig.toml" >"$work/score"
	sed 's/^/# /' "$work/score"
	check "$(basename "$scene" .toml): $least % found, no false point" awk -v least="$least" \
		'/balls found/ { if ($3 < least / 100 * $5) exit 1 } /points not balls/ { if ($4 != 0) exit 1; n++ } END { exit !n }' \
		"$work/score"
}

# A white ball before a white wall, so many grey levels brighter than it in noise of 1.6.
for contrast in 6 10; do
	cat >"$work/contrast$contrast.toml" <<END
[light]
level = $((195 + contrast))
ambient = 1
hemisphere = 0
diffuse = 0
shadow = 0
[background]
level = 195
contrast = 1
END
done
printf 'base = "people"\n[flights]\ngap = 30\n' >"$work/people-alone.toml"
check_hard "$work/contrast10.toml" 96 --flights 1
check_hard "$work/contrast6.toml" 94 --flights 1
check_hard people 85 --flights 1
check_hard "$work/people-alone.toml" 0 --frames 60
check_hard paper60 99 --flights 5
finish

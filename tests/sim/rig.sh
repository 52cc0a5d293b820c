# Simulated cameras with faults, and the tracker on them. Source it after lib.sh.
rate=110
tracker_options=() # more of them

# Fault, pulses, seed: run both until so many pulses have come, which begin when a camera is ready for them. Then the
# tracker's words are in track.log, its table in track.txt, the truth in truth.txt, and its status in $status. While the
# tracker runs, its number is given to the function `meanwhile`, where there is one.
run() {
	rm -f "$work/true.toml" "$work/simulate.log" "$work/truth.txt"
	"$bin/pongeye-simulate" --cameras --rate $rate --seed "$3" --rig "$work/true.toml" --truth "$work/truth.txt" \
		--frames "$2" --fault "$1" 2>"$work/simulate.log" &
	local simulator=$! tracker
	while kill -0 $simulator 2>/dev/null && ! grep -qs 'cameras on' "$work/simulate.log"; do sleep 0.05; done
	{ cat "$work/true.toml"; printf '\n[capture]\nrate = %d\n' $rate; } >"$work/rig.toml"
	"$bin/pongeye-track" --rig "$work/rig.toml" --output "$work/track.txt" "${tracker_options[@]}" \
		2>"$work/track.log" &
	tracker=$!
	declare -F meanwhile >/dev/null && meanwhile $tracker $simulator
	while kill -0 $simulator 2>/dev/null && kill -0 $tracker 2>/dev/null; do sleep 0.1; done
	kill -INT $tracker $simulator 2>/dev/null
	wait $simulator
	wait $tracker
	status=$?
}

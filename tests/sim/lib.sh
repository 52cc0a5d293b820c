# What the test scripts share. Source it: `. "$(dirname "$0")/lib.sh"`.
set -u
cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit 1
export BUILD=${BUILD:-build}
bin=$PWD/$BUILD/bin
work=$(mktemp -d)
failures=0
trap 'rm -rf "$work"' EXIT

ok() { echo "ok - $1"; }
not_ok() { echo "not ok - $1"; failures=$((failures + 1)); }

# what, command ...: the command must succeed.
check() {
	local what=$1
	shift
	if "$@" >"$work/check.log" 2>&1; then ok "$what"; else
		not_ok "$what"
		sed 's/^/# /' "$work/check.log"
	fi
}

# value, bound: for check; what is no number is above every bound.
at_most() { awk -v value="$1" -v bound="$2" 'BEGIN { exit !(value + 0 == value && value <= bound) }'; }

# what, status, words, command ...: the command must end so, and say one line that holds the words.
check_refusal() {
	local what=$1 status=$2 words=$3 got
	shift 3
	"$@" >"$work/refusal.out" 2>"$work/refusal.err"
	got=$?
	if [ $got -eq "$status" ] && grep -qF -- "$words" "$work/refusal.err" && [ "$(wc -l <"$work/refusal.err")" -eq 1 ]; then
		ok "$what"
	else
		not_ok "$what"
		echo "# status $got, not $status, or not the one line '$words':"
		sed 's/^/# /' "$work/refusal.err"
	fi
}

# Run this script again in a network of its own, where its ports and its multicast are nobody else's; where that is not
# allowed, go on in the common one.
private_network() {
	[ -n "${PONGEYE_PRIVATE_NETWORK:-}" ] && return
	export PONGEYE_PRIVATE_NETWORK=yes
	local user=()
	[ "$(id -u)" -eq 0 ] || user=(--map-root-user)
	if unshare --net "${user[@]}" true 2>/dev/null; then
		rm -rf "$work"
		exec unshare --net "${user[@]}" bash -c 'ip link set lo up && ip route add 224.0.0.0/4 dev lo && exec "$0"' "$0"
	fi
}

finish() { [ $failures -eq 0 ]; exit; }

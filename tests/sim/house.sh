#!/bin/bash
# The house rules: who may use whom.
. "$(dirname "$0")/lib.sh"

# what, pattern, files ...: no line of the files may match.
check_none() {
	local what=$1 pattern=$2
	shift 2
	if grep -nE -- "$pattern" "$@" >"$work/found"; then
		not_ok "$what"
		sed 's/^/# /' "$work/found"
	else
		ok "$what"
	fi
}

sources() { find "$@" \( -name '*.cpp' -o -name '*.hpp' -o -name '*.c' -o -name '*.h' \); }

allowed='#include (<(algorithm|array|cassert|cerrno|cmath|cstdarg|cstddef|cstdint|cstdio|cstdlib|cstring|functional|initializer_list|limits|memory|new|string|type_traits|utility|vector|stddef\.h|stdint\.h|Eigen/[A-Za-z]+|toml\+\+/toml\.h|immintrin\.h|arm_neon\.h)>|")'
grep -nE '^ *#include' $(sources lib) | grep -vE "$allowed" >"$work/foreign"
if [ -s "$work/foreign" ]; then
	not_ok "the library needs Eigen and toml++, nothing else"
	sed 's/^/# /' "$work/foreign"
else
	ok "the library needs Eigen and toml++, nothing else"
fi
check_none "the library does not print, exit, start threads or read clocks" \
	'\b(printf|fprintf|puts|exit|abort|pthread_create|std::thread|clock_gettime|gettimeofday|std::chrono)\b *\(' $(sources lib | grep -v pongeye.h)
check_none "the simulator shares no code with the library" '#include .*(pongeye\.h|lib/)' $(sources tools/simulate)
check_none "tools include nothing of the library but pongeye.h" \
	"#include \"(../)*(lib/)($(cd lib && ls *.hpp | sed 's/\./\\./' | paste -sd'|'))\"" $(sources tools)
if [ -d trigger/firmware ]; then
	grep -nE '^ *#include "' $(sources trigger/firmware) | grep -vE '"([a-z_]+\.h|\.\./protocol\.h)"' >"$work/firmware"
	check "firmware includes nothing but protocol.h and its own" test ! -s "$work/firmware"
fi

# The order of the data: LIB in the Makefile, the sections of pongeye.h and the README's file list agree.
stages='rig region detect locate reconstruct track predict window eye'
in_makefile=$(make -s print-LIB | tr ' ' '\n' | grep -xE "$(tr ' ' '|' <<<"$stages")" | paste -sd' ')
in_header=$(sed -nE 's/^ \* (Rig|Region|Detect|Locate|Reconstruct|Track|Predict|Window|Eye):.*/\L\1/p' lib/pongeye.h | paste -sd' ')
in_readme=$(sed -nE 's/^lib\/([a-z]+)\.cpp .*/\1/p' README.md | paste -sd' ')
check "the Makefile lists the library in the order of the data" test "$in_makefile" = "$stages"
check "the header's sections follow the data" test "$in_header" = "$stages"
check "the README's file list follows the data" test "$in_readme" = "$stages"
check "every file that the README lists is there" \
	bash -c 'for f in $(sed -nE "s/^((lib|tools|lcmtypes|tests)[^ ]*) .*/\1/p" README.md); do test -e $f || { echo $f; exit 1; }; done'
finish

#!/bin/bash
# The README's program is the example, and the example works: installed, found by pkg-config, compiled as C, run.
. "$(dirname "$0")/lib.sh"

check "the README shows docs/examples/hit.c" \
	bash -c 'diff <(sed -n "/^#include/,\$p" docs/examples/hit.c) <(sed -n "/^\`\`\`c/,/^\`\`\`\$/p" README.md | sed "1d;\$d")'
check "make install" make install DESTDIR="$work/root" PREFIX=/usr
export PKG_CONFIG_PATH=$work/root/usr/lib/pkgconfig PKG_CONFIG_SYSROOT_DIR=$work/root
check "the example compiles as C11 with pkg-config's flags" bash -c \
	"${CC:-cc} -std=c11 -Wall -Wextra -Werror docs/examples/hit.c \$(pkg-config --define-variable=prefix=/usr --cflags --libs pongeye) \
	 ${SANITIZE:+-fsanitize=$SANITIZE} -o $work/hit"
export LD_LIBRARY_PATH=$work/root/usr/lib
"$bin/pongeye-simulate" --out "$work/flight" --flights 1 2>/dev/null
if command -v pngtopnm >/dev/null; then
	for left in "$work"/flight/*-left.png; do
		pngtopnm "$left" | tail -c 307200
		pngtopnm "${left%-left.png}-right.png" | tail -c 307200
	done | "$work/hit" "$work/flight/rig.toml" >"$work/hits"
	check "the example predicts hits" test "$(grep -c '^hit at x' "$work/hits")" -gt 20
else
	echo "skip - the example predicts hits (pngtopnm of package netpbm is missing)"
fi
check_refusal "the example names a missing rig" 1 "no/rig.toml: No such file" "$work/hit" no/rig.toml
for program in "$work"/root/usr/bin/pongeye-*; do
	check "$(basename "$program") --help shows an example" bash -c "$program --help | grep -qi '^Example:'"
	check "$(basename "$program") --version" bash -c "$program --version | grep -qE '^$(basename "$program") [0-9]+\.[0-9]+'"
	check_refusal "$(basename "$program") refuses an unknown option" 2 "--nonsense" "$program" --nonsense
done
finish

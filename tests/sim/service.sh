#!/bin/bash
# The tracker's example of a systemd service: systemd reads it without a complaint, and it leaves little to attack.
. "$(dirname "$0")/lib.sh"
if ! systemd-analyze security --offline=true --help >/dev/null 2>&1; then
	echo "skip - systemd-analyze is not here, or too old"
	finish
fi
unit=$work/pongeye-track.service
sed "s#/usr/local/bin#$bin#" tools/track/pongeye-track.service >"$unit"
said=$(systemd-analyze verify "$unit" 2>&1)
check "systemd finds nothing to complain about" test -z "$said"
check "its exposure is at most 2.0" systemd-analyze security --offline=true --no-pager --threshold=20 "$unit"
finish

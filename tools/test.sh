#!/usr/bin/env bash
# Everything that must pass: builds, then unit, property, golden, measured, integration, short stress and fuzz tests.
#   tools/test.sh [ctest arguments]      e.g. tools/test.sh -L unit
# Ends with "N passed, M skipped" and why; exit status 0 where none failed.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/setup.sh
tools/build.sh
# LCM's tests send to a multicast address on this machine only; without a route for it nothing arrives.
if [ "$(id -u)" -eq 0 ] && command -v ip >/dev/null && ! ip route show table all | grep -q '^multicast\|^224\.'; then
  ip route add 224.0.0.0/4 dev lo 2>/dev/null || true
fi
results=$PWD/build/release/test_results
rm -f "$results".*
status=0
ctest --test-dir build/release --output-on-failure --output-junit "$results.xml" -j "$(nproc)" "$@" || status=$?
[ -f "$results.xml" ] || exit "$status" # nothing was run (-N)
ctest --test-dir build/release --show-only=json-v1 >"$results.json"
tools/test_summary.py "$results.xml" "$results.json" || status=$((status > 0 ? status : 1))
exit "$status"

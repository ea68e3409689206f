#!/usr/bin/env bash
# Everything that must pass: builds, then unit, property, golden, measured, integration, short stress and fuzz tests.
#   tools/test.sh [--quick] [ctest arguments]      e.g. tools/test.sh -L unit
#     --quick   property and golden tests, unit tests but for the long ones (tests/CMakeLists.txt names them), and a short
#               integration (one run of the service, one replay): within three processor minutes; only these are built
# Ends with "N passed, M skipped" and why; exit status 0 where none failed.
set -euo pipefail
cd "$(dirname "$0")/.."
targets=() # all
case ${1:-} in
  -h | --help) sed -n '2,/^set/s/^# \{0,1\}//p' "$0" && exit 0 ;;
  --quick)
    shift
    targets=(hovermodal hovermodald hovermodal-validate integration_tests property_tests golden_tests)
    for room in tests/unit/*/; do
      ! compgen -G "${room}*_test.cpp" >/dev/null || targets+=("unit_$(basename "$room")_tests")
    done
    set -- -L '^(unit|property|golden|integration_quick)$' "$@"
    ;;
esac
tools/setup.sh
tools/build.sh "${targets[@]}"
# LCM's tests send to a multicast address on this machine only; without a route for it nothing arrives.
if [ "$(id -u)" -eq 0 ] && command -v ip >/dev/null && ! ip route show table all | grep -q '^multicast\|^224\.'; then
  ip route add 224.0.0.0/4 dev lo 2>/dev/null || true
fi
results=$PWD/build/release/test_results
rm -f "$results".*
status=0
ctest --test-dir build/release --output-on-failure --output-junit "$results.xml" --test-output-size-passed 10000000 -j "$(nproc)" "$@" || status=$?
[ -f "$results.xml" ] || exit "$status" # nothing was run (-N)
ctest --test-dir build/release --show-only=json-v1 >"$results.json"
tools/test_summary.py "$results.xml" "$results.json" || status=$((status > 0 ? status : 1))
exit "$status"

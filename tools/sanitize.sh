#!/usr/bin/env bash
# AddressSanitizer with UndefinedBehaviorSanitizer, then ThreadSanitizer, over unit, stress and integration tests. Each
# is a build of its own (presets asan, tsan): the first run takes long. --quick: rt and stress tests only.
#   tools/sanitize.sh [--quick]
set -euo pipefail
cd "$(dirname "$0")/.."
targets=(unit_core_tests unit_rt_tests unit_drivers_tests unit_firmware_app_tests stress_tests integration_tests)
[ "${1:-}" != --quick ] || targets=(unit_rt_tests stress_tests)
tools/setup.sh
export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1 ASAN_OPTIONS=detect_stack_use_after_return=1
# OpenCV, GLib and libsystemd are not built for it: their own locks are invisible to it.
export TSAN_OPTIONS="suppressions=$PWD/tools/tsan_suppressions.txt halt_on_error=0 exitcode=66"
failed=()
for preset in asan tsan; do
  cmake --preset $preset >/dev/null
  cmake --build --preset $preset --target "${targets[@]}"
  for target in "${targets[@]}"; do
    "build/$preset/tests/$target" --gtest_brief=1 || failed+=("$preset:$target")
  done
done
if [ ${#failed[@]} -gt 0 ]; then
  echo "sanitize: failed: ${failed[*]}"
  exit 1
fi
echo "sanitize: ${targets[*]} clean under address, undefined and thread"

#!/usr/bin/env bash
# AddressSanitizer with UndefinedBehaviorSanitizer, then ThreadSanitizer, over unit, stress and integration tests. Each
# is a build of its own, whose first run takes an hour or more on two processors. --quick: rt and stress tests only.
#   tools/sanitize.sh [--quick] [asan] [tsan]      default: both
set -euo pipefail
cd "$(dirname "$0")/.."
quick=
[ "${1:-}" != --quick ] || { quick=yes && shift; }
presets=("$@")
[ $# -gt 0 ] || presets=(asan tsan)
tools/setup.sh
# A library's request that is too large must fail as it does without a sanitizer: by std::bad_alloc. Stack frames that
# AddressSanitizer keeps for use after return are not aligned for the 64-byte vectors that GCC 12 puts there.
export ASAN_OPTIONS=detect_stack_use_after_return=0:allocator_may_return_null=1
export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
# OpenCV, GLib and others are not built for it: their own locks are invisible to it.
export TSAN_OPTIONS="suppressions=$PWD/tools/tsan_suppressions.txt halt_on_error=0 exitcode=66"
failed=()
for preset in "${presets[@]}"; do
  cmake --preset $preset >/dev/null
  if [ -n "$quick" ]; then
    cmake --build --preset $preset --target unit_rt_tests stress_tests
    build/$preset/tests/unit_rt_tests --gtest_brief=1 && build/$preset/tests/stress_tests --gtest_brief=1 || failed+=("$preset")
  else
    cmake --build --preset $preset --target unit_{core,rt,drivers,firmware_app,tools,structure}_tests stress_tests integration_tests
    ctest --test-dir build/$preset --output-on-failure -j "$(nproc)" -L '^(unit|stress|integration)$' || failed+=("$preset")
  fi
done
if [ ${#failed[@]} -gt 0 ]; then
  echo "sanitize: findings or failures under ${failed[*]}"
  exit 1
fi
echo "sanitize: ${quick:+rt and stress tests }clean under ${presets[*]} (asan: address and undefined; tsan: thread)"

#!/usr/bin/env bash
# Figure 3 of shipping: every reader of what comes from outside, fuzzed. One line a target; three hours on two processors
# (for scene and replay all of core is built under the sanitizers first), --quick: 20 s each and without these two, some minutes.
#   tools/figures/shipping_fuzz.sh [--quick] [--first-seed N] [TARGET...]      the seed is libFuzzer's
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/shipping_fuzz.sh [--quick] [--first-seed N] [TARGET...]" "$@"
[ -z "$quick" ] || [ ${#figures[@]} -gt 0 ] || left_out=(scene replay)
all_or_named config calibration timestamps series lcm datagrams checkpoint http record scene replay
seconds=600 targets=("${figures[@]}")
[ -z "$quick" ] || seconds=20
set_up --fuzz
out=$PWD/build/figures/shipping
mkdir -p "$out"

figure_3() {
  local target text verdict kept_bytes
  for target in "${targets[@]}"; do
    if [[ " ${left_out[*]-} " == *" $target "* ]]; then
      line "3.$target" SKIP "not with --quick" "10 minutes without a finding" "run: tools/figures/shipping_fuzz.sh $target"
      continue
    fi
    # A short run without a finding is no measurement of the bar; a finding misses it at once.
    verdict=ok
    [ -z "$quick" ] || verdict=SKIP
    text=$(tools/fuzz.sh "$target" --seconds $seconds --seed "$first_seed" --coverage 2>"$out/fuzz_$target.err") || verdict=MISS
    [ -n "$text" ] || text=$(tail -n 1 "$out/fuzz_$target.err")
    line "3.$target" $verdict "$(head -n 1 <<<"$text" | sed 's/^[a-z]* //')" "10 minutes without a finding, coverage printed" \
      "libFuzzer with AddressSanitizer and UndefinedBehaviorSanitizer, $seconds s from seed $first_seed, tests/fuzz/targets/${target}_target.cpp"
    [ $verdict != MISS ] || tail -n +2 <<<"$text"
  done
  kept_bytes=$(find tests/fuzz/corpus -type f -printf '%s\n' | awk '{ n += $1 } END { print n + 0 }')
  judge 3.corpus "$(find tests/fuzz/corpus -type f | wc -l) inputs, $kept_bytes bytes" "below 200 kB" "kept in the project, run by every tools/test.sh" \
    "$kept_bytes > 1000 && $kept_bytes < 200000"
}

run_figures 3

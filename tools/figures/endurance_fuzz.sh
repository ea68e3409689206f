# Figures 7_readers and 7_programs of endurance.sh: every fuzz target anew. Sourced by it.
# shellcheck shell=bash

figure_7_readers() { fuzz_targets config calibration timestamps clip_telemetry series matrix_market checkpoint record; }
figure_7_programs() { fuzz_targets lcm datagrams http mavlink replay scene identify batch; }

# From an empty corpus but for the kept one; a target a processor. A short run without a finding is no measurement of the bar.
fuzz_targets() { # TARGET...
  local target said verdict seconds=600
  [ -z "$quick" ] || seconds=20
  if ! quietly tools/setup.sh --fuzz; then
    line "$figure" SKIP "no clang" "600 s each without a finding; coverage in lines stated" "tools/setup.sh --fuzz, as root, brings it"
    return
  fi
  for target in "$@"; do rm -rf "build/fuzz/corpus/$target" "build/fuzz/findings/$target"; done
  tools/fuzz.sh "$@" --seconds $seconds --seed "$first_seed" --jobs "$(nproc)" --coverage >"$work/fuzz.txt" 2>"$work/fuzz.err" || true
  for target in "$@"; do
    said=$(grep "^$target " "$work/fuzz.txt" || true)
    verdict=MISS
    [[ $said != "$target clean: "* || $said == *" 0 of 0 lines"* ]] || verdict=$([ -z "$quick" ] && echo ok || echo SKIP)
    line "7.$target" "$verdict" "${said#"$target "}$([ -n "$said" ] || tail -n 1 "$work/fuzz.err")" "600 s each without a finding; coverage in lines stated" \
      "libFuzzer with AddressSanitizer and UndefinedBehaviorSanitizer, $seconds s from seed $first_seed, tests/fuzz/targets/${target}_target.cpp"
  done
}

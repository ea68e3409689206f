#!/usr/bin/env bash
# The real-time runtime, figure by figure; one line each, MISS where a bar is not met. About 40 minutes; --quick: 6.
#   tools/figures/runtime.sh [--quick] [FIGURE...]      e.g. tools/figures/runtime.sh --quick 1 5
# Figures 1 and 7 measure time: leave the machine alone meanwhile.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
transfers=100000000 tsan_transfers=10000000 arm_transfers=1000000 hook_frames=10000 kills=200 stops=500 soak_frames=1000000
overload_s=60 latency_s=30 rounds=40
quick=
if [ "${1:-}" = --quick ]; then
  quick=1
  transfers=2000000 tsan_transfers=200000 arm_transfers=100000 hook_frames=1000 kills=40 stops=20 soak_frames=60000
  overload_s=10 latency_s=6 rounds=20
  shift
fi
wanted=" ${*:-1 2 3 4 5 6 7 8} "
wants() { [[ $wanted == *" $1 "* ]]; }
out=$PWD/build/figures/runtime
mkdir -p "$out"
tools/setup.sh --runtime
flags=(-std=c++20 -O2 -I. -pthread)

# --- 1: ring and triple buffer ----------------------------------------------------------------------------------------
transfer_line() { # NUMBER FILE WHAT: of ring_transfers
  local verdict=MISS
  [ "$(awk -F'\t' '$6 == 0 && $3 == "written" { n++ } END { print n + 0 }' "$2")" != 2 ] || verdict=ok
  line "$1" $verdict "$(awk -F'\t' '{ printf "%s%s: %s read, %s bad, %s s", (NR > 1 ? "; " : ""), $1, $4, $6, $8 }' "$2")" "0 bad" "$3"
}
model_line() { # MODEL VARIANT... : the protocol passes, each weaker variant is caught
  local model=$1 states caught=0 n=0
  shift
  (cd "$out" && spin -a "$OLDPWD/tests/model/$model.pml" >/dev/null && gcc -O2 -w -o pan pan.c && ./pan -m200000 >"$model.txt")
  states=$(awk '/states, stored/ { print $1 }' "$out/$model.txt")
  for variant in "$@"; do
    n=$((n + 1))
    (cd "$out" && spin -a "-D$variant" "$OLDPWD/tests/model/$model.pml" >/dev/null && gcc -O2 -w -o pan pan.c && ./pan -m200000 >"$model.$variant.txt")
    ! grep -q 'errors: 1' "$out/$model.$variant.txt" || caught=$((caught + 1))
  done
  local complete
  complete=$(grep -c 'errors: 0' "$out/$model.txt" || true)
  judge 1 "0 errors in $states states; $caught of $n weaker variants caught" "0 errors, all caught" \
    "SPIN, explicit store buffers: $model" "$complete == 1 && $caught == $n"
}
figure_1() {
  quietly tools/build.sh ring_transfers ring_speed
  "$bin/ring_transfers" $transfers 2 >"$out/transfers.txt" || true
  transfer_line 1 "$out/transfers.txt" "$transfers transfers of 67 words, both CPUs loaded"
  g++ "${flags[@]}" -g -fsanitize=thread tests/bench/ring_transfers.cpp rt/wakeup.cpp -o "$out/ring_transfers_tsan"
  local verdict=MISS
  "$out/ring_transfers_tsan" $tsan_transfers >"$out/tsan.txt" 2>"$out/tsan_warnings.txt" || true
  [ -s "$out/tsan_warnings.txt" ] || verdict=ok
  transfer_line 1 "$out/tsan.txt" "$tsan_transfers transfers under ThreadSanitizer"
  line 1 $verdict "$(grep -c WARNING "$out/tsan_warnings.txt" || true) warnings" "0" "ThreadSanitizer's findings in them"
  aarch64-linux-gnu-g++ "${flags[@]}" -static tests/bench/ring_transfers.cpp rt/wakeup.cpp -o "$out/ring_transfers_arm64"
  qemu-aarch64 "$out/ring_transfers_arm64" $arm_transfers >"$out/arm64.txt" || true
  transfer_line 1 "$out/arm64.txt" "$arm_transfers transfers as an arm64 binary under user-mode emulation"
  aarch64-linux-gnu-g++ "${flags[@]}" -march=armv8.1-a -c tests/bench/ring_instructions.cpp -o "$out/ring_arm64.o"
  aarch64-linux-gnu-objdump -d --no-show-raw-insn "$out/ring_arm64.o" >"$out/ring_arm64.asm"
  local function pattern found=
  for pair in ring_try_claim:ldap*r ring_publish:stlr ring_front:ldap*r ring_pop:stlr triple_publish:swpal triple_refresh:swpal; do
    function=${pair%%:*} pattern=${pair#*:}
    found+=" $function $(awk -v f="<$function>:" -v p="\t$pattern\t" '$0 ~ f { on = 1; next } /^$/ { on = 0 } on && $0 ~ p { print $2; exit }' "$out/ring_arm64.asm");"
  done
  judge 1 "$(echo $found)" "acquire load, release store" "arm64 instructions of the index accesses" \
    "\"$(echo "$found" | grep -oE 'ldap?r|stlr|swpal' | wc -l)\" == 6"
  model_line spsc_ring WRITE_RELAXED READ_RELAXED POP_RELAXED CLAIM_RELAXED RELEASE_ONLY
  model_line triple_buffer PUBLISH_RELAXED PUBLISH_RELEASE_ONLY REFRESH_RELAXED REFRESH_ACQUIRE_ONLY
  # Spinning threads measure the scheduler wherever something else runs: with SCHED_FIFO where that is allowed.
  local first=()
  ! chrt -f 20 true 2>/dev/null || first=(chrt -f 20)
  "${first[@]}" "$bin/ring_speed" $rounds >"$out/speed.txt"
  local ours theirs ratio
  read -r _ ours theirs ratio <<<"$(grep ^words "$out/speed.txt")"
  judge 1 "$ours ns against $theirs ns, ratio $ratio" ">= 1" "one-word items beside boost::lockfree::spsc_queue, median of $rounds rounds" "$ratio >= 1"
  read -r _ ours theirs ratio <<<"$(grep ^frames "$out/speed.txt")"
  judge 1 "$ours ns against $theirs ns, ratio $ratio" "> 1" "frames of 1280 x 720 beside it" "$ratio > 1"
}
! wants 1 || figure_1

# --- 2: neither allocation nor lock -----------------------------------------------------------------------------------
figure_2() {
  quietly tools/build.sh hooks_tests
  HOVERMODAL_HOOK_FRAMES=$hook_frames HOVERMODAL_HOOK_REPORT=$out/hooks.tsv build/release/tests/hooks_tests >"$out/hooks.txt" 2>&1 ||
    line 2 MISS "$(grep -cE '^.*Failure$' "$out/hooks.txt") failures, see hooks.txt" 0 "test of the calls in the run path"
  local thread own library
  for thread in hm-capture hm-tracking hm-spectrum; do
    own=$(awk -F'\t' -v t=$thread '$1 == "site" && $2 == t && $8 == "ours" { n += $4 } END { print n + 0 }' "$out/hooks.tsv")
    library=$(awk -F'\t' -v t=$thread '$1 == "site" && $2 == t && $8 == "library" { n += $4 } END { print n + 0 }' "$out/hooks.tsv")
    judge 2 "$own of ours, $library inside OpenCV" "0 of ours; OpenCV's listed" \
      "allocations and locks of $thread over $hook_frames frames" "$own == 0 && $(grep -c "^thread.$thread" "$out/hooks.tsv" || true) <= 1"
  done
  awk -F'\t' '$1 == "site" && $2 == "hm-tracking" { printf "  %s %s in %s (%s) from %s\n", $4, $3, $6, $5, $7 }' "$out/hooks.tsv" | head -n 40
}
! wants 2 || figure_2

# --- 3: overload ------------------------------------------------------------------------------------------------------
figure_3() {
  quietly tools/build.sh overload_run
  local verdict
  for kind in overload loss; do
    verdict=MISS
    ! "$bin/overload_run" $kind $overload_s >"$out/$kind.txt" || verdict=ok
    line 3 $verdict "$(tr '\t\n' ' ;' <"$out/$kind.txt")" "in = processed + dropped, memory flat, modes right" \
      "$([ $kind = overload ] && echo "source four times too fast, $overload_s s" || echo "30 % random loss")"
  done
}
! wants 3 || figure_3

# --- 4: stop at any moment --------------------------------------------------------------------------------------------
figure_4() {
  quietly tools/build.sh hovermodald hovermodal
  local verdict=MISS
  ! tools/figures/runtime_stop.py "$bin" "$out/stop" $stops >"$out/stop.txt" || verdict=ok
  line 4 $verdict "$(cat "$out/stop.txt")" "within 300 ms plus the longest step, all reports complete" "$stops random SIGTERM and SIGINT"
}
! wants 4 || figure_4

# --- 5: kill ----------------------------------------------------------------------------------------------------------
figure_5() {
  quietly tools/build.sh kill_resume unit_drivers_tests
  local verdict=MISS
  ! "$bin/kill_resume" "$out/kill" $kills >"$out/kill.txt" || verdict=ok
  line 5 $verdict "$(tr '\t' ';' <"$out/kill.txt")" "0 refused, <= 1, equal" "$kills random SIGKILLs of spectrum and checkpoint stage, resumed"
  verdict=MISS
  ! build/release/tests/unit_drivers_tests --gtest_filter='CheckpointFile.*' >"$out/checkpoint.txt" 2>&1 || verdict=ok
  line 5 $verdict "$(grep -c '  OK ' "$out/checkpoint.txt" || true) tests" "all pass" "disk full, no folder, every truncation, every flipped bit"
}
! wants 5 || figure_5

# --- 6: soak ----------------------------------------------------------------------------------------------------------
figure_6() {
  quietly tools/build.sh overload_run
  local verdict=MISS
  ! "$bin/overload_run" soak $soak_frames >"$out/soak.txt" || verdict=ok
  line 6 $verdict "$(tr '\t\n' ' ;' <"$out/soak.txt")" "memory growth 0 after 20 000 frames, counters consistent" "$soak_frames frames as fast as possible, estimates meanwhile"
}
! wants 6 || figure_6

# --- 7: latency -------------------------------------------------------------------------------------------------------
figure_7() {
  quietly tools/build.sh overload_run
  local load priority verdict
  for load in 0 2; do
    for priority in 0 80; do
      verdict=MISS
      ! "$bin/overload_run" latency $latency_s $load $priority >"$out/latency_${load}_$priority.txt" || verdict=ok
      line 7 $verdict "$(tr '\t\n' ' ;' <"$out/latency_${load}_$priority.txt")" "every frame counted; none dropped where nothing else runs" \
        "frame to displacement, 1920 x 1080 at 60 frames a second, $load CPUs loaded, $([ $priority = 0 ] && echo ordinary || echo SCHED_FIFO)"
    done
  done
}
! wants 7 || figure_7

# --- 8: sanitizers ----------------------------------------------------------------------------------------------------
figure_8() {
  local verdict=MISS
  ! tools/sanitize.sh ${quick:+--quick} >"$out/sanitize.txt" 2>&1 || verdict=ok
  line 8 $verdict "$(tail -n 1 "$out/sanitize.txt")" "clean" "ASan, UBSan and TSan over unit, stress and integration tests"
}
! wants 8 || figure_8

[ $misses -eq 0 ]

#!/usr/bin/env bash
# The real-time runtime, figure by figure; one line each, MISS where a bar is not met. About an hour; --quick: ten minutes.
#   tools/figures/runtime.sh [--quick] [--first-seed N] [FIGURE...]      e.g. tools/figures/runtime.sh --quick 1 5
# FIGURE: 1 (ring and triple buffer), 2 (no allocation, no lock), 3 (overload, loss), 4 (stop), 5 (kill), 6 (soak),
# 7 (latency), 8 (sanitizers). Figures 1 and 7 measure time: leave the machine alone meanwhile.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/runtime.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
all_or_named 1 2 3 4 5 6 7 8
draws 3 4 5 6 7
transfers=100000000 tsan_transfers=10000000 arm_transfers=1000000 hook_frames=10000 kills=200 stops=500 soak_frames=1000000
overload_s=60 latency_s=30 rounds=40 records=10
[ -z "$quick" ] || {
  transfers=2000000 tsan_transfers=200000 arm_transfers=100000 hook_frames=1000 kills=20 stops=20 soak_frames=60000
  overload_s=10 latency_s=6 rounds=20 records=2
}
seeds() { echo "seeds $first_seed to $((first_seed + $1 - 1))"; }
out=$PWD/build/figures/runtime
mkdir -p "$out"
[[ " ${figures[*]} " == *" 1 "* ]] && set_up --runtime || set_up
flags=(-std=c++20 -O2 -I. -pthread)
value() { awk -F'\t' -v name="$2" '$1 == name { v = $2 } END { print v == "" ? "nan" : v }' "$out/$1.txt"; } # FILE NAME
in_one_line() { tr '\t\n' ' ;' <"$1" | tail -c 400; }

# --- 1: ring and triple buffer ----------------------------------------------------------------------------------------
transfer_line() { # NUMBER FILE WHAT: of ring_transfers
  local verdict=MISS
  [ "$(awk -F'\t' '$6 == 0 && $3 == "written" { n++ } END { print n + 0 }' "$2")" != 2 ] || verdict=ok
  line "$1" $verdict "$(awk -F'\t' '{ printf "%s%s: %s read, %s bad, %s s", (NR > 1 ? "; " : ""), $1, $4, $6, $8 }' "$2")" "0 bad" "$3"
}
model_line() { # MODEL VARIANT...: the protocol passes, each weaker variant is detected
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
  # Spinning threads measure the scheduler if anything else runs: SCHED_FIFO is used where permitted.
  local first=()
  ! chrt -f 20 true 2>/dev/null || first=(chrt -f 20)
  "${first[@]}" "$bin/ring_speed" $rounds >"$out/speed.txt"
  local ours theirs ratio
  read -r _ ours theirs ratio <<<"$(grep ^words "$out/speed.txt")"
  judge 1 "$ours ns against $theirs ns, ratio $ratio" ">= 1" "one-word items beside boost::lockfree::spsc_queue, median of $rounds rounds" "$ratio >= 1"
  read -r _ ours theirs ratio <<<"$(grep ^frames "$out/speed.txt")"
  judge 1 "$ours ns against $theirs ns, ratio $ratio" "> 1" "frames of 1280 x 720 beside it" "$ratio > 1"
}
# --- 2: neither allocation nor lock -----------------------------------------------------------------------------------
figure_2() {
  quietly tools/build.sh hooks_tests
  rm -f "$out/hooks.tsv"
  HOVERMODAL_HOOK_FRAMES=$hook_frames HOVERMODAL_HOOK_REPORT=$out/hooks.tsv build/release/tests/hooks_tests >"$out/hooks.txt" 2>&1 ||
    line 2 MISS "$(grep -cE '^.*Failure$' "$out/hooks.txt") failures, see hooks.txt" 0 "test of the calls in the run path"
  local thread own library counted
  counted=$(grep -c '^thread' "$out/hooks.tsv" 2>/dev/null || true)
  for thread in hm-capture hm-tracking hm-spectrum; do
    own=$(awk -F'\t' -v t=$thread '$1 == "site" && $2 == t && $8 == "ours" { n += $4 } END { print n + 0 }' "$out/hooks.tsv")
    library=$(awk -F'\t' -v t=$thread '$1 == "site" && $2 == t && $8 == "library" { n += $4 } END { print n + 0 }' "$out/hooks.tsv")
    judge 2 "$own of ours, $library inside OpenCV; $counted threads made any" "no allocation and no lock, waiting only where the house style allows it" \
      "$thread over $hook_frames frames served from memory, after prepare()" "$own == 0 && $library == 0 && ${counted:-0} > 0"
  done
  awk -F'\t' '$1 == "site" && $2 == "hm-tracking" { printf "  %s %s in %s (%s) from %s\n", $4, $3, $6, $5, $7 }' "$out/hooks.tsv" | head -n 40
}

# --- 3: overload ------------------------------------------------------------------------------------------------------
overload_line() {
  local verdict=MISS
  ! "$bin/overload_run" --seed "$first_seed" overload $overload_s >"$out/overload.txt" || verdict=ok
  line 3.overload $verdict "$(in_one_line "$out/overload.txt")" "memory flat, frames in = processed + dropped exactly, modes still right from what was kept" \
    "a source four times faster than tracking can follow, $overload_s s, seed $first_seed; flat: less than 4 MB from the half on"
}
# Frames rendered and lost in memory, through the whole pipeline.
loss_line() {
  local seed n=0 wrong=0 measured=
  for seed in $(seq "$first_seed" $((first_seed + records - 1))); do
    "$bin/overload_run" --seed "$seed" loss $overload_s >"$out/loss_$seed.txt" || {
      wrong=$((wrong + 1))
      measured+="; seed $seed: $(in_one_line "$out/loss_$seed.txt")"
    }
    [ -z "$(value "loss_$seed" modes | grep -v nan)" ] || n=$((n + 1))
  done
  measured="$wrong of $n records wrong$measured"
  judge 3.loss "$measured" "memory flat, frames in = processed + dropped exactly, modes still right from what was kept" \
    "30 % of the frames lost at random, $overload_s s of video in memory, $(seeds "$records"); right: the lowest three within 2 %" \
    "$n == $records && $wrong == 0"
}
# The same by the public programs, starting from tracks: all modes that the record shows without losses.
public_loss_line() {
  local what="30 % of the frames lost at random, tracks of 60 s, $(seeds 10), hovermodal simulate and replay; kept: what the same record shows without losses, within 2 %"
  rm -f "$out/public_loss.txt"
  tools/figures/runtime_loss.py "$bin" "$out/loss" 60 "$first_seed" 10 >"$out/public_loss.txt" 2>"$out/public_loss.err" ||
    { line 3.public MISS "it ended early: $(grep . "$out/public_loss.err" | tail -n 1)" "modes still right from what was kept" "$what"; return; }
  v() { value public_loss "$1"; }
  judge 3.public "a mode is lost in $(v records_with_a_lost_mode) of $(v records) records (one of the lowest three in $(v records_with_one_of_three)), $(v lost) of $(v shown) modes ($(v which)), worst of the others $(v worst_percent) %; $(v missing_percent) % missing" \
    "frames in = processed + dropped exactly, modes still right from what was kept" "$what" \
    "$(v records) == 10 && $(v records_with_a_lost_mode) == 0 && $(v uneven) == 0 && $(v shown) > 20 && $(v missing_percent) > 25"
}
figure_3() {
  quietly tools/build.sh overload_run hovermodal
  overload_line
  loss_line
  public_loss_line
}

# --- 4: stop at any moment --------------------------------------------------------------------------------------------
figure_4() {
  quietly tools/build.sh hovermodald hovermodal
  local verdict=MISS
  ! tools/figures/runtime_stop.py "$bin" "$out/stop" $stops "$first_seed" >"$out/stop.txt" || verdict=ok
  line 4 $verdict "$(cat "$out/stop.txt")" "stages stopped within 300 ms plus the longest step, no message torn, report complete" \
    "$stops random SIGTERM and SIGINT times under load, $(seeds "$stops")"
}
# --- 5: kill ----------------------------------------------------------------------------------------------------------
# hovermodald itself, on a clip played at its own pace.
service_lines() {
  local what="$kills random SIGKILLs of hovermodald with resume, $(seeds "$kills")"
  rm -f "$out/kill_runs.txt" "$out/kill_account.txt"
  { tools/figures/runtime_kill.py "$bin" "$out/kill_service" $kills "$first_seed" >"$out/kill_runs.txt" &&
    "$bin/kill_account" "$out/kill_service" >"$out/kill_account.txt"; } 2>"$out/kill_service.err" ||
    { line 5.service MISS "it ended early: $(grep . "$out/kill_service.err" | tail -n 1)" "no corrupt checkpoint accepted, at most period_s of data lost, accumulators bit-equal" "$what"; return; }
  r() { value kill_runs "$1"; }
  a() { value kill_account "$1"; }
  judge 5.checkpoint "$(a kills) kills, $(a resumed) runs known to have gone on; $(a unreadable) states left corrupt, $(r refused) refused; $(r damaged_refused) of $(r damaged) truncated or with a flipped bit refused" \
    "no corrupt checkpoint accepted" "$what" \
    "$(a kills) == $kills && 2 * $(a resumed) >= $kills && $(a unreadable) == 0 && $(r refused) == 0 && $(r damaged) > 0 && $(r damaged_refused) == $(r damaged)"
  judge 5.loss "$(a worst_loss_s) s at most, counted from when the killed run opened its clip" "at most period_s of data lost" "$what; state.period_s: 2" \
    "$(a worst_loss_s) <= 2 && $(a states) > 0"
  judge 5.equal "$(a equal) of $(a states) states equal (first other: $(a first_wrong)), the last of $(a cells) samples; $(a other_frames) of $(a frames) frames that the killed runs recorded are others than a whole run's" \
    "accumulators bit-equal to an uninterrupted run with the same frames missing" "$what; every byte of the state after each kill, against sums that were never written or read again" \
    "$(a states) > 0 && $(a equal) == $(a states) && $(a frames) > 0 && $(a other_frames) == 0"
  unwritable_line "disk full" "$(r full)" "No space"
  unwritable_line "read-only" "$(r read_only)" "Read-only"
}
unwritable_line() { # WHAT WORDS EXPECTED
  local what="hovermodald where the folder of its state is on a disk that is ${1#disk }" verdict=MISS
  if [ "$2" = skip ]; then
    line "5.${1// /_}" SKIP "no mount of one's own is allowed here" "covered" "$what; run it as root"
    return
  fi
  [[ $2 != *"$3"* ]] || verdict=ok
  line "5.${1// /_}" $verdict "the run came to its end and says: $2" "covered" "$what"
}
figure_5() {
  quietly tools/build.sh hovermodal hovermodald kill_account kill_resume unit_drivers_tests
  service_lines
  local verdict=MISS
  ! "$bin/kill_resume" "$out/kill" $kills "$first_seed" >"$out/kill.txt" || verdict=ok
  line 5.stages $verdict "$(tr '\t' ';' <"$out/kill.txt")" "no corrupt checkpoint accepted, at most period_s of data lost, accumulators bit-equal" \
    "$kills random SIGKILLs of spectrum and checkpoint stage alone, on white noise at 10 kHz, resumed, seed $first_seed"
  verdict=MISS
  ! build/release/tests/unit_drivers_tests --gtest_filter='CheckpointFile.*' >"$out/checkpoint.txt" 2>&1 || verdict=ok
  line 5.file $verdict "$(grep -c '  OK ' "$out/checkpoint.txt" || true) tests" "disk full and truncated checkpoint covered" "the checkpoint file: disk full, no folder, every truncation, every flipped bit"
}

# --- 6: soak ----------------------------------------------------------------------------------------------------------
figure_6() {
  quietly tools/build.sh overload_run
  local verdict=MISS
  ! "$bin/overload_run" --seed "$first_seed" soak $soak_frames >"$out/soak.txt" || verdict=ok
  line 6 $verdict "$(tr '\t\n' ' ;' <"$out/soak.txt")" "resident memory growth 0 after start-up, counters consistent" "$soak_frames frames as fast as possible, estimates meanwhile, seed $first_seed; start-up: 20 000 frames"
}
# --- 7: latency -------------------------------------------------------------------------------------------------------
figure_7() {
  quietly tools/build.sh overload_run
  local load priority verdict name
  for load in 0 2; do
    for priority in 0 80; do
      verdict=MISS name=latency_${load}_$priority
      ! "$bin/overload_run" --seed "$first_seed" latency $latency_s $load $priority >"$out/$name.txt" 2>"$out/$name.err" || verdict=ok
      # Without that right the thread runs at ordinary priority: another figure.
      ! grep -q 'priority .* refused' "$out/$name.err" || verdict=SKIP
      line 7 $verdict "$(in_one_line "$out/$name.txt")$([ $verdict != SKIP ] || echo "; SCHED_FIFO was refused: run it as root, or ulimit -r 99")" \
        "latency and jitter printed; every frame counted, none dropped where nothing else runs" \
        "frame to displacement, 1920 x 1080 at 60 frames a second, $load CPUs loaded, $([ $priority = 0 ] && echo ordinary || echo SCHED_FIFO), seed $first_seed"
    done
  done
}

# --- 8: sanitizers ----------------------------------------------------------------------------------------------------
figure_8() {
  local verdict=MISS
  ! tools/sanitize.sh ${quick:+--quick} >"$out/sanitize.txt" 2>&1 || verdict=ok
  line 8 $verdict "$(tail -n 1 "$out/sanitize.txt")" "clean" "ASan, UBSan and TSan over $([ -n "$quick" ] && echo 'the tests of rt and stress only' || echo 'unit, stress and integration tests')"
}
run_figures "${figures[@]}"

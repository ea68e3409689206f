#!/usr/bin/env bash
# Fuzzes what comes from outside: every reader of a file, a message or a request (tests/fuzz/targets), under AddressSanitizer and
# UndefinedBehaviorSanitizer, from the kept corpus on. One line a target; ends with 1 where one has a finding.
#   tools/fuzz.sh [TARGET...] [--seconds S] [--coverage] [--keep]
#     TARGET       config calibration timestamps series lcm datagrams checkpoint http record (default: all of these), or
#                  replay: the whole way from a record to its modes, for which all of core is built
#     --seconds    of each target; default 60
#     --coverage   also how many edges of the sources concerned the inputs reach
#     --keep       adds what reaches further to tests/fuzz/corpus, the smallest inputs that do
# What was found lies in build/fuzz/findings/TARGET. To see it again: build/fuzz/bin/fuzz_TARGET FILE
set -euo pipefail
cd "$(dirname "$0")/.."
targets=() seconds=60 coverage= keep=
while [ $# -gt 0 ]; do
  case $1 in
    --seconds) seconds=$2; shift 2 ;;
    --coverage) coverage=yes; shift ;;
    --keep) keep=yes; shift ;;
    -*) echo "usage: tools/fuzz.sh [TARGET...] [--seconds S] [--coverage] [--keep]" >&2; exit 2 ;;
    *) targets+=("$1"); shift ;;
  esac
done
[ ${#targets[@]} -gt 0 ] || targets=(config calibration timestamps series lcm datagrams checkpoint http record)
for target in "${targets[@]}"; do
  [ -f "tests/fuzz/targets/${target}_target.cpp" ] || { echo "fuzz: $target: no such target; there are: $(cd tests/fuzz/targets && ls | sed 's/_target.cpp//' | paste -sd' ')" >&2; exit 2; }
done

tools/setup.sh --fuzz
[ -f build/fuzz/build.ninja ] || cmake --preset fuzz >/dev/null
cmake --build build/fuzz --target "${targets[@]/#/fuzz_}" >build/fuzz/build.log 2>&1 || { grep -E -A12 'error|FAILED' build/fuzz/build.log | head -n 60 >&2; exit 1; }
export ASAN_OPTIONS=allocator_may_return_null=1:detect_stack_use_after_return=0 UBSAN_OPTIONS=print_stacktrace=1
export ASAN_SYMBOLIZER_PATH=${ASAN_SYMBOLIZER_PATH:-$(command -v llvm-symbolizer-14 llvm-symbolizer | head -n 1)}
# The checkpoint target writes files and brings them to the disk: in memory that is a thousand times faster.
[ ! -w /dev/shm ] || export TMPDIR=/dev/shm

# Whose edges count for a target: what reads its input, not what it is built on.
concerned() {
  case $1 in
    config) echo 'firmware_app/config[_a-z]*[.]|storage/(yaml|key_suggestion|text_file)[.]' ;;
    calibration) echo 'storage/(calibration_[a-z]*|yaml)[.]|geometry/(camera_model|lens_fault)[.]' ;;
    timestamps) echo 'recording/timestamp_file[.]' ;;
    series) echo 'storage/(csv[_a-z]*|foreign_series|series_format|timed_columns|attitude_file)[.]' ;;
    lcm) echo 'telemetry/(stream_monitor|layout_watch|topics|decode|channel_count)[.]|ground/(json_[a-z]*|live_stream|snapshot_json)[.]|hovermodal/[a-z_]*_t[.]hpp' ;;
    datagrams) echo 'telemetry/lcm_datagrams[.]' ;;
    checkpoint) echo 'storage/checkpoint_file[.]|firmware_app/(kept_keyframe|run_state|byte_archive)[.]|types/state_bytes[.]|identification/mode_tracker[.]|spectrum/(welch_[a-z]*|time_grid)[.]' ;;
    http) echo 'ground/web_[a-z]*[.]' ;;
    record) echo 'telemetry/(event_log_reader|run_record_reader|encode_run|record_folder)[.]|firmware_app/run_head[.]|hovermodal/run_[a-z_]*t[.]hpp' ;;
    replay) echo 'firmware_app/(track_replay|record_replay|track_analysis|run_view)[.]|core/geometry/' ;;
  esac
}
# Functions by the file that defines them, with edges reached and there: "reached total".
edges() { # TARGET FOLDER...
  local target=$1
  shift
  "build/fuzz/bin/fuzz_$target" -runs=0 -print_coverage=1 "$@" 2>&1 | awk -v files="$(concerned "$target")" '
    /COVERED_FUNC: hits:/ && $NF ~ files { split($5, n, "/"); reached += n[1]; total += n[2] }
    END { print reached + 0, total + 0 }'
}

failed=0
for target in "${targets[@]}"; do
  kept=tests/fuzz/corpus/$target grown=build/fuzz/corpus/$target findings=build/fuzz/findings/$target log=build/fuzz/$target.log
  mkdir -p "$kept" "$grown" "$findings"
  verdict=clean
  "build/fuzz/bin/fuzz_$target" -max_total_time="$seconds" -max_len=32768 -timeout=20 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="$findings/" "$grown" "$kept" >"$log" 2>&1 || { verdict=FINDING; failed=1; }
  read -r runs peak < <(awk -F': *' '/stat::number_of_executed_units/ { n = $2 } /stat::peak_rss_mb/ { m = $2 } END { print n + 0, m + 0 }' "$log")
  read -r cov ft corp < <(awk '/ cov: / { for (i = 1; i < NF; i++) { if ($i == "cov:") c = $(i + 1); if ($i == "ft:") f = $(i + 1); if ($i == "corp:") k = $(i + 1) } } END { print c + 0, f + 0, k }' "$log")
  of=
  [ -z "$coverage" ] || read -r reached total < <(edges "$target" "$grown" "$kept")
  [ -z "$coverage" ] || of=", $reached of $total edges of the sources concerned"
  echo "$target $verdict: $seconds s, $runs inputs, cov $cov, ft $ft, corpus ${corp:-0}$of, $peak MB"
  if [ $verdict = FINDING ]; then
    grep -m 3 -E 'ERROR|runtime error|SUMMARY|what\(\)' "$log" | sed 's/^/  /' || true
    echo "  $(ls -t "$findings"/* | head -n 1), $log"
  fi
  [ -z "$keep" ] || "build/fuzz/bin/fuzz_$target" -merge=1 -max_len=4096 "$kept" "$grown" >>"$log" 2>&1 || failed=1
done
exit $failed

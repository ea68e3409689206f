#!/usr/bin/env bash
# Fuzzes what comes from outside: every reader of a file, a message or a request (tests/fuzz/targets), under AddressSanitizer and
# UndefinedBehaviorSanitizer, from the kept corpus on. One line a target; ends with 1 where one has a finding.
#   tools/fuzz.sh [TARGET...] [--seconds S] [--seed N] [--jobs N] [--coverage] [--keep]
#     TARGET       config calibration timestamps clip_telemetry series matrix_market lcm datagrams mavlink checkpoint http record (default: all of
#                  these); or replay (the whole way from a record to its modes), scene (of the simulator; the structures of
#                  closeloop), identify and batch (these commands as a whole)
#     --seconds    of each target; default 60
#     --jobs       targets at a time; default 1
#     --seed       of libFuzzer's draws; default: another one each time
#     --coverage   also how many lines of the sources concerned the inputs reach
#     --keep       adds what reaches further to tests/fuzz/corpus, the smallest inputs that do
# What was found lies in build/fuzz/findings/TARGET. To see it again: build/fuzz/bin/fuzz_TARGET FILE
set -euo pipefail
cd "$(dirname "$0")/.."
targets=() seconds=60 seed=0 jobs=1 coverage='' keep=''
while [ $# -gt 0 ]; do
  case $1 in
    --seconds) seconds=$2; shift 2 ;;
    --seed) seed=$2; shift 2 ;;
    --jobs) jobs=$2; shift 2 ;;
    --coverage) coverage=yes; shift ;;
    --keep) keep=yes; shift ;;
    -*) echo "usage: tools/fuzz.sh [TARGET...] [--seconds S] [--seed N] [--jobs N] [--coverage] [--keep]" >&2; exit 2 ;;
    *) targets+=("$1"); shift ;;
  esac
done
[ ${#targets[@]} -gt 0 ] || targets=(config calibration timestamps clip_telemetry series matrix_market lcm datagrams mavlink checkpoint http record)
for target in "${targets[@]}"; do
  [ -f "tests/fuzz/targets/${target}_target.cpp" ] || { echo "fuzz: $target: no such target; there are: $(cd tests/fuzz/targets && ls | sed 's/_target.cpp//' | paste -sd' ')" >&2; exit 2; }
done

tools/setup.sh --fuzz
[ -f build/fuzz/build.ninja ] || cmake --preset fuzz >/dev/null
cmake --build build/fuzz --target "${targets[@]/#/fuzz_}" >build/fuzz/build.log 2>&1 || { grep -E -A12 'error|FAILED' build/fuzz/build.log | head -n 60 >&2; exit 1; }
export ASAN_OPTIONS=allocator_may_return_null=1:detect_stack_use_after_return=0 UBSAN_OPTIONS=print_stacktrace=1
export LLVM_PROFILE_FILE=/dev/null
export ASAN_SYMBOLIZER_PATH=${ASAN_SYMBOLIZER_PATH:-$(command -v llvm-symbolizer-14 llvm-symbolizer | head -n 1)}
# The checkpoint target synchronises files to disk: in memory this is a thousand times faster.
[ ! -w /dev/shm ] || export TMPDIR=/dev/shm

# Sources whose lines count for a target: those that read its input, not those below them.
concerned() {
  case $1 in
    config) echo firmware_app/config/config{,_check,_key,_sections_input,_sections_output,_sections_scale,_table,_yaml}.cpp drivers/storage/{yaml,key_suggestion,text_file}.cpp ;;
    calibration) echo drivers/storage/{calibration_file,calibration_text,yaml}.cpp core/geometry/{camera_model,lens_fault}.cpp ;;
    clip_telemetry) echo drivers/camera/recording/{gpmf,srt_file}.cpp ;;
    mavlink) echo drivers/mavlink/mavlink_{clock,companion,frame,messages}.cpp ;;
    identify) echo tools/hovermodal/identify/{identify,sample_grid,series_input,series_output}.cpp ;;
    batch) echo tools/hovermodal/batch/{combine,dispatch,flight,flight_order,inventory,json,picture,text}.cpp ;;
    matrix_market) echo drivers/storage/matrix_market.cpp ;;
    timestamps) echo drivers/camera/recording/timestamp_file.cpp ;;
    series) echo drivers/storage/{csv,csv_lines,csv_series,foreign_series,series_format,timed_columns,attitude_file}.cpp ;;
    lcm) echo drivers/telemetry/{stream_monitor,layout_watch,topics}.cpp drivers/telemetry/decode.h tools/hovermodal/ground/{json_series,json_status,live_stream,snapshot_json}.cpp ;;
    datagrams) echo drivers/telemetry/lcm_datagrams.cpp ;;
    checkpoint) echo drivers/storage/checkpoint_file.cpp firmware_app/{service/kept_keyframe,chain/state/run_state}.cpp core/identification/mode_tracker.cpp core/spectrum/{welch_state,time_grid}.cpp ;;
    http) echo tools/hovermodal/ground/{web_connections,web_guard,web_head,web_routes}.cpp tools/hovermodal/regions/picker_json.cpp ;;
    record) echo drivers/telemetry/{event_log_reader,run_record_reader,encode_run}.cpp firmware_app/chain/state/{run_head,keyframe_jpeg}.cpp ;;
    scene) echo drivers/storage/{structure_{file,kinds,value},matrix_market,scene/{build,flight,key,keys_camera,keys_motion,keys_plates,keys_structure,presets,reader,table,writer}}.cpp core/simulation/scene_validation.cpp ;;
    replay) echo firmware_app/{replay/track_replay,replay/record_replay,replay/track_analysis,chain/state/run_view}.cpp core/geometry/channel_displacement.cpp ;;
  esac
}
# Of these sources, the lines that the inputs reach: "reached total". Some lines serve other callers: writers of a
# checkpoint or a record, listeners on a socket.
lines() { # TARGET FOLDER...
  local target=$1 raw=build/fuzz/profiles/$1.raw
  shift
  LLVM_PROFILE_FILE=$raw "build/fuzz/bin/fuzz_$target" -runs=0 "$@" >/dev/null 2>&1
  llvm-profdata-14 merge -o "$raw.data" "$raw"
  # The report omits the beginning common to all names.
  llvm-cov-14 report "build/fuzz/bin/fuzz_$target" -instr-profile="$raw.data" 2>/dev/null | awk -v files="$(concerned "$target")" '
    function ends(text, with) { return text == with || substr(text, length(text) - length(with)) == "/" with }
    BEGIN { n = split(files, file, " ") }
    NF > 9 { for (i = 1; i <= n; i++) if (ends($1, file[i]) || ends(file[i], $1)) { reached += $8 - $9; total += $8 } }
    END { print reached + 0, total + 0 }'
}

fuzz() { # TARGET: its line on standard output; 1: it has a finding
  local target=$1 verdict=clean failed=0 of='' runs peak cov ft corp reached total
  local kept=tests/fuzz/corpus/$target grown=build/fuzz/corpus/$target findings=build/fuzz/findings/$target log=build/fuzz/$target.log
  mkdir -p "$kept" "$grown" "$findings" build/fuzz/profiles
  "build/fuzz/bin/fuzz_$target" -max_total_time="$seconds" -seed="$seed" -max_len=32768 -timeout=20 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="$findings/" "$grown" "$kept" >"$log" 2>&1 || { verdict=FINDING; failed=1; }
  read -r runs peak < <(awk '/stat::number_of_executed_units/ { n = $NF } /stat::peak_rss_mb/ { m = $NF } END { print n + 0, m + 0 }' "$log")
  read -r cov ft corp < <(awk '/ cov: / { for (i = 1; i < NF; i++) { if ($i == "cov:") c = $(i + 1); if ($i == "ft:") f = $(i + 1); if ($i == "corp:") k = $(i + 1) } } END { print c + 0, f + 0, k }' "$log")
  [ -z "$coverage" ] || read -r reached total < <(lines "$target" "$grown" "$kept")
  [ -z "$coverage" ] || of=", $reached of $total lines of the sources concerned"
  echo "$target $verdict: $seconds s, $runs inputs, cov $cov, ft $ft, corpus ${corp:-0}$of, $peak MB"
  if [ $verdict = FINDING ]; then
    grep -m 3 -E 'ERROR|runtime error|SUMMARY|what\(\)' "$log" | sed 's/^/  /' || true
    echo "  $(ls -t "$findings"/* | head -n 1), $log"
  fi
  [ -z "$keep" ] || "build/fuzz/bin/fuzz_$target" -merge=1 -max_len=4096 "$kept" "$grown" >>"$log" 2>&1 || failed=1
  return $failed
}

failed=0 running=0
await_one() {
  wait -n || failed=1
  running=$((running - 1))
}
for target in "${targets[@]}"; do
  [ "$running" -lt "$jobs" ] || await_one
  fuzz "$target" &
  running=$((running + 1))
done
while [ "$running" -gt 0 ]; do await_one; done
exit $failed

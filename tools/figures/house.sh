#!/usr/bin/env bash
# The house itself. One chain with two drivers: an edit of form changes no byte (1), a replay gives the bytes of its run (2).
# What a build and the tests cost (3), the shape of the code beside others' (4), passages of its prose (5).
#   tools/figures/house.sh [--before BIN] [--keep] [--quick] [--beside DIR]... [FIGURE...]    FIGURE: some of 1 ... 5 (default: all)
#     --before BIN   figure 1 compares with the programs in that folder (hovermodal, hovermodald of another build), on the same
#                    clips, instead of with the hashes in house_hashes.txt
#     --keep         figure 1 writes its hashes into house_hashes.txt: after a change that is meant to change results
#     --quick        figure 3 measures one library and one test program only
#     --beside DIR   figure 4: the sources of kiss-icp, libcamera, drake's lcm folder or cactus-rt; the folder's name names them
# 1 and 2 take six minutes on two processors, 3 some 200 processor minutes (--quick: five), 4 and 5 seconds.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
before='' keep='' beside=() rest=()
while [ $# -gt 0 ]; do
  case $1 in
    --before | --beside)
      [ -d "${2:-}" ] || refuse "$1: a folder is expected, got \"${2:-}\""
      if [ "$1" = --before ]; then before=$2; else beside+=("${2%/}"); fi
      shift
      ;;
    --keep) keep=1 ;;
    *) rest+=("$1") ;;
  esac
  shift
done
take_arguments "tools/figures/house.sh [--before BIN] [--keep] [--quick] [--beside DIR]... [FIGURE...]" "${rest[@]}"
all_or_named 1 2 3 4 5
out=$PWD/build/figures/house
hashes=tools/figures/house_hashes.txt
files=(modal.json tracks.csv displacements.csv closure.json)
mkdir -p "$out"
tools/setup.sh

# The inputs: a clip of a minute with an undeclared lens, and tracks with missing points.
inputs() {
  quietly tools/build.sh hovermodal hovermodald
  local in=$out/input
  [ ! -s "$in/done" ] || return 0
  rm -rf "$in" && mkdir -p "$in"
  cat >"$in/scene.yaml" <<'Y'
preset: paper
duration_s: 60
seed: 3
declare: {lens: false}
camera: {lens: {model: radial_tangential, k: [-0.2, 0, 0, 0, 0]}}
Y
  quietly "$bin/hovermodal" simulate --scene "$in/scene.yaml" --size 640x360 --out "$in/clip" --threads "$(nproc)"
  quietly "$bin/hovermodal" simulate --scene "$in/scene.yaml" --tracks-only --track-noise-px 0.03 --track-loss 0.02 --points 15 --out "$in/tracks"
  touch "$in/done"
}
common=(--set telemetry.lcm_url= --set tracking.points_per_region=12)
brief=(--set closure.window_s=24 --set closure.period_s=20 --set closure.delay_s=4)
# service BIN FOLDER OPTION...: the service on the clip.
service() {
  local programs=$1 folder=$2
  shift 2
  quietly "$programs/hovermodald" --config "$out/input/clip/config.yaml" "${common[@]}" "$@" --report "$folder"
}
# again BIN FOLDER TRACKS CONFIG OPTION...: a replay of tracks.
again() {
  local programs=$1 folder=$2 tracks=$3 config=$4
  shift 4
  mkdir -p "$folder"
  quietly "$programs/hovermodal" replay --tracks "$tracks" --config "$config" "${common[@]}" "$@" --report "$folder"
}

# --- 1: the same bytes ------------------------------------------------------------------------------------------------
# ten_runs BIN FOLDER: outputs of both levels of the chain, with and without corrections.
ten_runs() {
  local b=$1 f=$2 clip=$out/input/clip tracks=$out/input/tracks
  rm -rf "$f" && mkdir -p "$f"
  service "$b" "$f/off" --set closure.adopt=off
  service "$b" "$f/report" --set closure.adopt=report "${brief[@]}"
  service "$b" "$f/auto" --set closure.adopt=auto "${brief[@]}" --set "record.directory=$f/record"
  service "$b" "$f/paper" --set method=paper --set closure.adopt=off
  service "$b" "$f/whole_motion" --set scale.only=false --set spectrum.segment=256 --set closure.adopt=off
  again "$b" "$f/replay_off" "$f/off/tracks.csv" "$clip/config.yaml" --set closure.adopt=off
  again "$b" "$f/replay_auto" "$f/off/tracks.csv" "$clip/config.yaml" --set closure.adopt=auto "${brief[@]}"
  again "$b" "$f/replay_paper" "$f/off/tracks.csv" "$clip/config.yaml" --set method=paper --set closure.adopt=off
  again "$b" "$f/replay_lost_points" "$tracks/tracks.csv" "$tracks/config.yaml" --set closure.adopt=off
  mkdir -p "$f/replay_record"
  quietly "$b/hovermodal" replay "$f"/record/*_000.lcm --report "$f/replay_record"
}
# hashes_of FOLDER: one line per file, sorted.
hashes_of() {
  local names=()
  for file in "${files[@]}"; do names+=(-o -name "$file"); done
  (cd "$1" && find . -type f \( "${names[@]:1}" \) -printf '%P\n' | LC_ALL=C sort | xargs -d '\n' sha256sum)
}
figure_1() {
  inputs
  ten_runs "$bin" "$out/runs"
  hashes_of "$out/runs" >"$out/hashes.txt"
  [ -z "$keep" ] || cp "$out/hashes.txt" "$hashes"
  local reference=$hashes with="house_hashes.txt"
  if [ -n "$before" ]; then
    ten_runs "$before" "$out/runs_before"
    hashes_of "$out/runs_before" >"$out/hashes_before.txt"
    reference=$out/hashes_before.txt with="the programs in $before"
  fi
  local n same
  n=$(cat "$reference" "$out/hashes.txt" | awk '{ print $2 }' | sort -u | wc -l)
  same=$(sort "$reference" "$out/hashes.txt" | uniq -d | wc -l)
  judge 1 "$same of $n files of ten runs are the same bytes" "all" "${files[*]}, compared with $with" "$same == $n && $n >= 30"
  sort "$reference" "$out/hashes.txt" | uniq -u | awk '{ print "  differs: " $2 }' | sort -u
}

# --- 2: run = replay --------------------------------------------------------------------------------------------------
# recorded NAME OPTION...: the service on the clip, with a run record.
recorded() {
  local folder=$out/again/$1
  shift
  service "$bin" "$folder/live" "${brief[@]}" --set "record.directory=$folder/record" "$@"
}
# compared NAME FOUND CONDITION: the newest record of that run replayed, file by file; FOUND checks that the case occurred.
compared() {
  local folder=$out/again/$1 same=0 n=0 file record
  mkdir -p "$folder/again"
  record=$(find "$folder/record" -name '*_000.lcm' | LC_ALL=C sort | tail -n 1)
  "$bin/hovermodal" replay "$record" --report "$folder/again" >"$folder/replay.txt"
  for file in "${files[@]}"; do
    [ -e "$folder/live/$file" ] || [ -e "$folder/again/$file" ] || continue
    n=$((n + 1))
    ! cmp -s "$folder/live/$file" "$folder/again/$file" || same=$((same + 1))
  done
  local apart
  apart=$(python3 - "$folder/live/modal.json" "$folder/again/modal.json" <<'PY'
import json, sys
a, b = (json.load(open(path)) for path in sys.argv[1:])
print(" ".join(key for key in sorted({*a, *b}) if a.get(key) != b.get(key)) or "none")
PY
)
  judge "2.$1" "$same of $n files the same bytes (parts of modal.json that differ: $apart); $2" "all" "the run's report and that of its record's replay" "$same == $n && $n >= 3 && $3"
}
# losses_of MODAL_JSON LOSS KEY: the two numbers.
losses_of() {
  python3 -c 'import json, sys; run = json.load(open(sys.argv[1])); print(run["losses"][sys.argv[2]], run[sys.argv[3]])' "$@"
}
figure_2() {
  inputs
  rm -rf "$out/again" && mkdir -p "$out/again"
  recorded corrections --set closure.adopt=auto
  local n_changes
  n_changes=$(grep -c 'from frame' "$out/again/corrections/live/modal.json" || true)
  compared corrections "$n_changes corrections in force" "$n_changes >= 1"

  # Thirteen frames are lost after the 400th, and forty seconds after the 900th.
  awk 'BEGIN { print "frame,t_s"; for (i = 0; i < 1500; i++) printf "%d,%.9f\n", i, (i + (i > 400) * 13 + (i > 900) * 1000) / 25 }' \
    >"$out/input/clip/clip.timestamps.csv"
  recorded gaps --set closure.adopt=report
  rm -f "$out/input/clip/clip.timestamps.csv"
  local n_missing samples
  read -r n_missing samples < <(losses_of "$out/again/gaps/live/modal.json" frames_missing samples)
  compared gaps "$n_missing frames missing" "$n_missing == 1013"

  # Killed during the run; the next run resumes from its state.
  local state=(--set "state.directory=$out/again/resume/state" --set state.period_s=1)
  "$bin/hovermodald" --config "$out/input/clip/config.yaml" "${common[@]}" "${brief[@]}" "${state[@]}" --set camera.pace=realtime \
    --set closure.adopt=off >"$out/again/killed.txt" 2>&1 &
  local killed=$!
  sleep 25
  kill -KILL "$killed"
  wait "$killed" || true
  recorded resume "${state[@]}" --set camera.pace=realtime --set closure.adopt=off
  read -r n_missing samples < <(losses_of "$out/again/resume/live/modal.json" frames_missing samples)
  compared resume "$samples samples of a clip of 1500" "$samples > 1800"

  # Eight times too fast, and tracking shares its processor with sixteen busy loops.
  local busy=()
  for _ in {1..16}; do
    taskset -c 0 timeout 300 bash -c 'while :; do :; done' &
    busy+=($!)
  done
  quietly "$bin/hovermodald" --config "$out/input/clip/config.yaml" --set telemetry.lcm_url= --set camera.pace=realtime \
    --set camera.rate_hz=200 --set camera.readout_ms=4 --set tracking.points_per_region=60 --set spectrum.segment=64 \
    --set closure.adopt=off --set rt.tracking_cpu=0 --set "record.directory=$out/again/overload/record" --report "$out/again/overload/live"
  kill "${busy[@]}"
  local n_dropped rate_hz
  read -r n_dropped rate_hz < <(losses_of "$out/again/overload/live/modal.json" frames_dropped rate_hz)
  compared overload "$n_dropped frames dropped, $rate_hz of 200 frames a second kept" "$n_dropped > 0 && $rate_hz < 200"
}

# --- 3: what a contributor waits for ----------------------------------------------------------------------------------
reference=02909f7
# processor_minutes FILE COMMAND...: user and system time of the command and all its children, into FILE.
processor_minutes() {
  python3 - "$@" <<'PY'
import resource, subprocess, sys
log = open(sys.argv[1] + ".log", "w")
status = subprocess.run(sys.argv[2:], stdout=log, stderr=log, stdin=subprocess.DEVNULL).returncode
used = resource.getrusage(resource.RUSAGE_CHILDREN)
with open(sys.argv[1], "w") as file:
    file.write(f"{(used.ru_utime + used.ru_stime) / 60:.3f}\n")
sys.exit(status)
PY
}
# scratch COMMIT: a clone of that commit, without any build, in $out/scratch/COMMIT. The compiler's cache is off.
scratch() {
  rm -rf "$out/scratch/$1"
  quietly git clone --quiet --shared --no-checkout . "$out/scratch/$1"
  quietly git -C "$out/scratch/$1" checkout --quiet "$(git rev-parse "$1")"
  export CCACHE_DISABLE=1
}
# build_cost COMMIT NAME TARGET...: processor minutes for these targets in its clone, including configuration for the first.
build_cost() {
  local commit=$1 name=$2
  shift 2
  processor_minutes "$out/cost_${name}_$commit.txt" "$out/scratch/$commit/tools/build.sh" "$@" || return 1
  cat "$out/cost_${name}_$commit.txt"
}
# compared_cost NUMBER BAR WHAT NOW BEFORE: the ratio of processor minutes; without a bar it is printed for comparison.
compared_cost() {
  local ratio
  ratio=$(awk "BEGIN { if ($5 > 0) printf \"%.2f\", $4 / $5; else print \"nan\" }")
  if [ "$2" = - ]; then
    line "$1" beside "$4 of $5 processor minutes, ratio $ratio" "-" "$3"
  else
    judge "$1" "$4 of $5 processor minutes, ratio $ratio" "<= $2" "$3" "$ratio <= $2"
  fi
}
figure_3() {
  local now commit what now_demo now_all before_demo before_all
  now=$(git rev-parse --short HEAD)
  if ! git cat-file -e "$reference^{commit}" 2>/dev/null; then
    line 3 SKIP "no history" "<= 0.40, <= 0.50, 3 min" "commit $reference is not in this clone (git fetch --unshallow)"
    return
  fi
  [ -z "$(git status --porcelain --untracked-files=no)" ] || echo "# measured: $now, without what is not committed"
  what="cold build without the compiler's cache, $now against $reference in the same run"
  for commit in "$now" "$reference"; do scratch "$commit"; done
  if [ -n "$quick" ]; then
    now_demo=$(build_cost "$now" part hovermodal_storage unit_rt_tests) || now_demo=nan
    before_demo=$(build_cost "$reference" part hovermodal_storage unit_rt_tests) || before_demo=nan
    compared_cost 3.part - "hovermodal_storage and unit_rt_tests only: $what" "$now_demo" "$before_demo"
    line 3.demo SKIP "not with --quick" "<= 0.40" "processor minutes of the demo's $what"
    line 3.tests SKIP "not with --quick" "<= 0.50" "processor minutes of all tests' $what"
    line 3.quick SKIP "not with --quick" "3 min" "processor minutes of tools/test.sh --quick"
  else
    now_demo=$(build_cost "$now" demo hovermodald hovermodal) || now_demo=nan
    before_demo=$(build_cost "$reference" demo hovermodald hovermodal) || before_demo=nan
    compared_cost 3.demo 0.40 "the programs of tools/demo.sh: $what" "$now_demo" "$before_demo"
    now_all=$(build_cost "$now" rest) || now_all=nan
    before_all=$(build_cost "$reference" rest) || before_all=nan
    compared_cost 3.tests 0.50 "everything, tests included: $what" \
      "$(awk "BEGIN { print $now_demo + $now_all }")" "$(awk "BEGIN { print $before_demo + $before_all }")"
    local passed=1 seconds=$SECONDS
    processor_minutes "$out/cost_quick.txt" "$out/scratch/$now/tools/test.sh" --quick || passed=0
    judge 3.quick "$(cat "$out/cost_quick.txt") processor minutes, $((SECONDS - seconds)) s; $(tail -n 1 "$out/cost_quick.txt.log")" "3 min" \
      "tools/test.sh --quick, already built" "$(cat "$out/cost_quick.txt") <= 3 && $passed"
  fi
  unset CCACHE_DISABLE
  rm -rf "$out/scratch"
}

# --- 4: its shape -----------------------------------------------------------------------------------------------------
# The file in each project that shows the path of an item (a frame, a scan, a message); the types named there are the concepts.
declare -A way_of=([kiss-icp]=cpp/kiss_icp/pipeline/KissICP.cpp [libcamera]=src/libcamera/camera.cpp [drake]=lcm/drake_lcm.cc
  [lcm]=drake_lcm.cc [cactus-rt]=src/cactus_rt/cyclic_thread.cc)
print_shape() { # NUMBER DIR WAY NAME
  local text
  text=$(tools/figures/code_shape.py shape "$2" ${3:+--way "$3"})
  line "4.$1" beside "$(head -n 1 <<<"$text")" "-" "$4; median, 90 %, largest"
  [ -z "$3" ] || echo "# concepts on the way of a frame: $(tail -n 1 <<<"$text")"
}
figure_4() {
  local own=$out/own folder name way
  rm -rf "$own" && mkdir -p "$own"
  git ls-files -z -- '*.h' '*.cpp' | xargs -0 cp --parents -t "$own"
  print_shape hovermodal "$own" firmware_app/service/data_flow.h "this tree, tests included"
  rm -rf "$own/tests"
  print_shape product "$own" "" "this tree without tests"
  for folder in "${beside[@]}"; do
    name=${folder##*/}
    way=${way_of[$name]:-}
    [ -n "$way" ] && [ -e "$folder/$way" ] || way=
    print_shape "$name" "$folder" "$way" "$folder"
  done
  [ ${#beside[@]} -gt 0 ] || line 4.beside SKIP "no other project's folder" "-" "kiss-icp, libcamera, drake's lcm, cactus-rt: --beside DIR..."
}

# --- 5: its prose -----------------------------------------------------------------------------------------------------
figure_5() {
  quietly tools/build.sh hovermodal hovermodald
  local own=$out/prose command programs=(--help-of "$bin/hovermodald --help" --help-of "$bin/hovermodald --help-config")
  rm -rf "$own" && mkdir -p "$own"
  git ls-files -z -- '*.h' '*.cpp' '*.sh' '*.py' '*.md' | xargs -0 cp --parents -t "$own"
  for command in $("$bin/hovermodal" --help | sed -n '/^Subcommands:$/,$s/^  \([a-z]*\) .*/\1/p'); do
    programs+=(--help-of "$bin/hovermodal $command --help")
  done
  tools/figures/code_shape.py passages "$own" --seed 1001 --count 20 "${programs[@]}" >"$out/passages.txt"
  line 5 beside "$(tail -n +2 "$out/passages.txt" | wc -l) passages, $(head -n 1 "$out/passages.txt" | tr -d '#' | xargs)" "-" "drawn with seed 1001 from comments, help and documents; read them:"
  tail -n +2 "$out/passages.txt" | sed 's/^/  /'
}

run_figures "${figures[@]}"

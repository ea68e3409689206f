#!/usr/bin/env bash
# One chain with two drivers: an edit of form changes no byte, and a replay gives the bytes of its run. Six minutes.
#   tools/figures/house.sh [--before BIN] [--keep] [FIGURE...]      FIGURE: some of 1, 2 (default: both)
#     --before BIN   figure 1 compares with the programs in that folder (hovermodal, hovermodald of another build), on the same
#                    clips, instead of with the hashes in house_hashes.txt
#     --keep         figure 1 writes its hashes into house_hashes.txt: after a change that is meant to change results
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
before='' keep=''
while [[ ${1:-} == --* ]]; do
  case $1 in
    --before) before=$2 && shift 2 ;;
    --keep) keep=1 && shift ;;
    *) echo "house.sh: $1 is no option of it" >&2 && exit 2 ;;
  esac
done
figures=("${@:-}")
[ -n "${figures[0]}" ] || figures=(1 2)
out=$PWD/build/figures/house
hashes=tools/figures/house_hashes.txt
files=(modal.json tracks.csv displacements.csv closure.json)
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh hovermodal hovermodald

# The inputs: a clip of a minute with a lens that nobody declares, and tracks that lack points.
inputs() {
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
# service BIN FOLDER OPTION...: the clip through the service.
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
# ten_runs BIN FOLDER: what both levels of the chain leave behind, corrections taken out and not.
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
# hashes_of FOLDER: a line a file, sorted.
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
# recorded NAME OPTION...: the clip through the service, which records it.
recorded() {
  local folder=$out/again/$1
  shift
  service "$bin" "$folder/live" "${brief[@]}" --set "record.directory=$folder/record" "$@"
}
# compared NAME FOUND CONDITION: the newest record of that run replayed, file by file; FOUND says that the situation was one.
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
  judge "2.$1" "$same of $n files the same bytes; $2" "all" "the run's report and that of its record's replay" "$same == $n && $n >= 3 && $3"
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

  # Thirteen frames are lost after the 400th, forty seconds' worth after the 900th.
  awk 'BEGIN { print "frame,t_s"; for (i = 0; i < 1500; i++) printf "%d,%.9f\n", i, (i + (i > 400) * 13 + (i > 900) * 1000) / 25 }' \
    >"$out/input/clip/clip.timestamps.csv"
  recorded gaps --set closure.adopt=report
  rm -f "$out/input/clip/clip.timestamps.csv"
  local n_missing samples
  read -r n_missing samples < <(losses_of "$out/again/gaps/live/modal.json" frames_missing samples)
  compared gaps "$n_missing frames missing" "$n_missing == 1013"

  # Killed on the way; the next run goes on with its state.
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

  # Eight times too fast, on one processor.
  local on_one=(taskset -c 0)
  quietly "${on_one[@]}" "$bin/hovermodald" --config "$out/input/clip/config.yaml" --set telemetry.lcm_url= --set camera.pace=realtime \
    --set camera.rate_hz=200 --set tracking.points_per_region=60 --set spectrum.segment=64 --set closure.adopt=off \
    --set "record.directory=$out/again/overload/record" --report "$out/again/overload/live"
  local n_dropped rate_hz
  read -r n_dropped rate_hz < <(losses_of "$out/again/overload/live/modal.json" frames_dropped rate_hz)
  compared overload "$n_dropped frames dropped, $rate_hz of 200 frames a second kept" "$n_dropped > 0 && $rate_hz < 200"
}

run_figures "${figures[@]}"

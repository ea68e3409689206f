#!/usr/bin/env bash
# Records of the service, replayed: the same estimates, to the last bit. One line a figure; two minutes, --quick: one.
#   tools/figures/ground_record.sh [--quick] [--first-seed N] [FIGURE...]      FIGURE: 3
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/ground_record.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
all_or_named 3
runs=10 duration_s=60
[ -z "$quick" ] || runs=4 duration_s=30
out=$PWD/build/figures/ground
mkdir -p "$out"
set_up
quietly tools/build.sh hovermodal hovermodald

# Every second run loses frames and detects effects, every third runs in real time and may drop frames, every fifth is
# recorded in many small files.
how() { # SEED
  local more=()
  [ $(($1 % 2)) = 0 ] || more+=(--set closure.adopt=auto --set closure.window_s=20 --set closure.period_s=20 --set closure.delay_s=10)
  [ $(($1 % 3)) != 0 ] || more+=(--set camera.pace=realtime)
  [ $(($1 % 5)) != 0 ] || more+=(--set record.file_mb=1 --set record.quota_mb=1000)
  echo "${more[@]}"
}
figure_3() {
  local seed folder same=0 files=0 file left record frames=0 bytes=0
  rm -rf "$out"/record_*
  for seed in $(seq "$first_seed" $((first_seed + runs - 1))); do
    folder=$out/record_$seed
    # shellcheck disable=SC2046
    quietly "$bin/hovermodald" --config "firmware_app/config/synthetic.yaml" --set "camera.synthetic.seed=$seed" --set "camera.synthetic.duration_s=$duration_s" \
      --set telemetry.lcm_url= --set "record.directory=$folder" $(how "$seed") --report "$folder/live"
    record=$(ls "$folder"/*_000.lcm)
    "$bin/hovermodal" replay "$record" --report "$folder/again" >"$folder/replay.txt"
    left=ok
    for file in modal.json displacements.csv tracks.csv; do cmp -s "$folder/live/$file" "$folder/again/$file" || left=$file; done
    [ $left != ok ] || same=$((same + 1))
    files=$((files + $(ls "$folder"/*.lcm | wc -l)))
    frames=$((frames + duration_s * 25)) bytes=$((bytes + $(cat "$folder"/*.lcm | wc -c)))
  done
  judge 3 "$same of $runs runs; $files files, $((bytes / frames)) bytes a frame" "$runs recorded runs, byte-identical estimates" \
    "modal.json, displacements.csv and tracks.csv of a replay are the run's, byte for byte, seeds $first_seed to $((first_seed + runs - 1))" "$same == $runs"
}
run_figures "${figures[@]}"

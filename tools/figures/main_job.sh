#!/usr/bin/env bash
# The figures of the main job: frames to modes over LCM, on simulated and on filmed video. One line a figure.
#   tools/figures/main_job.sh [--quick] [--first-seed N] [FIGURE...]
# FIGURE: some of 1a 1b 1c 1d 2 3 4 5 6 (default: all). --quick leaves out the rendered 30 s clip and takes 3 seeds for 10.
# 6 counts the frames of all runs that the others left in build/figures/main_job.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/main_job.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
all_or_named 1a 1b 1c 1d 2 3 4 5 6
seeds=10
[ -z "$quick" ] || seeds=3
out=build/figures/main_job
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh hovermodald hovermodal

# errors_of TABLE: "|error %| MAC" of modes 1-3, "1000 0" for a mode that was not found.
errors_of() {
  awk '$1 ~ /^[123]$/ { if (NF < 9) print 1000, 0; else { e = $4 < 0 ? -$4 : $4; print e, $5 / 100 } }' "$1"
}

# summary TABLE...: median and worst error and MAC over modes 1-3 of all tables, "med worst med worst found".
summary() {
  local all
  all=$(for table in "$@"; do errors_of "$table"; done)
  echo "$(echo "$all" | awk '$1 < 1000 { print $1 }' | median_and_worst)" \
    "$(echo "$all" | awk '$1 < 1000 { print -$2 }' | median_and_worst | awk '{ print -$1, -$2 }')" \
    "$(echo "$all" | awk '$1 < 1000' | wc -l)"
}

in_words() {  # SUMMARY WANTED
  echo "$1 $2" | awk '{ printf "%d of %d modes, error median %.3f worst %.3f %%, MAC median %.5f worst %.5f", $5, $6, $1, $2, $3, $4 }'
}

# judge_modes NUMBER WHAT TABLE...: against the paper's own result; its chain on the same tracks for comparison (PAPER).
judge_modes() {
  local number=$1 what=$2 ours paper wanted
  shift 2
  wanted=$((3 * $#))
  ours=$(summary "$@")
  paper=$(summary "${@/%.txt/_paper.txt}")
  local words=($ours)
  judge "$number" "$(in_words "$ours" $wanted)" "modes 1-3 found, error <= 1.04 %, MAC >= 0.9967" \
    "$what; beside: the paper's chain $(in_words "$paper" $wanted)" \
    "${words[4]} == $wanted && ${words[1]} <= 1.04 && ${words[3]} >= 0.9967"
}

# truth_of TABLE...: error against the true parameters in units of sqrt(zeta / (2 pi f T)); no bar, for comparison.
truth_of() {
  for table in "$@"; do awk '$1 ~ /^[123]$/ && NF >= 9 { e = $8 < 0 ? -$8 : $8; s = $9 < 0 ? -$9 : $9; print e, s }' "$table"; done |
    awk '{ e2 += $2 * $2; if ($1 > w) w = $1; if ($2 > ws) ws = $2 } END { if (!NR) print "nothing against the true parameters"; else printf "against the true parameters: worst %.2f %%, rms %.2f and worst %.2f of the least possible scatter", w, sqrt(e2 / NR), ws }'
}

compare_to_truth() {  # RESULT FOLDER TABLE
  "$bin/hovermodal" compare --result "$1" --reference "$2/true_motion/modal.json" --truth "$2/truth.json" >"$3"
}

# --- 1: the demo's clips, of the scene that declares everything, and tracks of many seeds -------------------------------------------------------------------
clip_figure() {  # NUMBER SECONDS FOLDER
  quietly tools/demo.sh --scene tools/scenes/paper.yaml --seconds "$2" --seed "$first_seed" --out "$3" || { line "$1" MISS "the demo failed" "-" "$2 s clip"; return; }
  compare_to_truth "$3/modal.json" "$3" "$3/table.txt"
  local segment=512
  [ "$2" -ge 45 ] || segment=256
  quietly "$bin/hovermodal" replay --tracks "$3/tracks.csv" --config "$3/config.yaml" --set method=paper \
    --set spectrum.segment=$segment --report "$3/paper"
  compare_to_truth "$3/paper/modal.json" "$3" "$3/table_paper.txt"
  judge_modes "$1" "$2 s of rendered 1080p25, seed $first_seed; $(truth_of "$3/table.txt")" "$3/table.txt"
}

track_figure() {  # NUMBER SECONDS SEGMENT
  local tables=() seed method
  for seed in $(seq "$first_seed" $((first_seed + seeds - 1))); do
    local folder=$out/tracks_$2_$seed
    quietly "$bin/hovermodal" simulate --preset paper --tracks-only --duration "$2" --seed "$seed" --force --out "$folder"
    quietly "$bin/hovermodal" identify --series "$folder/truth_displacements.csv" --base base --segment "$3" --report "$folder/true_motion"
    for method in hovermodal paper; do
      quietly "$bin/hovermodal" replay --tracks "$folder/tracks.csv" --config "$folder/config.yaml" --set method=$method \
        --set spectrum.segment="$3" --set report.tracks=false --report "$folder/$method"
    done
    compare_to_truth "$folder/hovermodal/modal.json" "$folder" "$folder/table.txt"
    compare_to_truth "$folder/paper/modal.json" "$folder" "$folder/table_paper.txt"
    tables+=("$folder/table.txt")
  done
  judge_modes "$1" "$2 s of tracks, $(seeds_of "$seeds"); $(truth_of "${tables[@]}")" "${tables[@]}"
}

figure_1a() { clip_figure 1a 60 "$out/demo60"; }
figure_1b() {
  if [ -n "$quick" ]; then line 1b SKIP "--quick draws one clip" "modes 1-3 found, error <= 1.04 %, MAC >= 0.9967" "30 s of rendered 1080p25"; return; fi
  clip_figure 1b 30 "$out/demo30"
}
figure_1c() { track_figure 1c 60 512; }
figure_1d() { track_figure 1d 30 256; }

. tools/figures/main_job_filmed.sh
. tools/figures/main_job_runs.sh
run_figures "${figures[@]}"

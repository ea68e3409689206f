#!/usr/bin/env bash
# Figure 16 of closing the loop: measured data. One line a figure.
#   tools/figures/closure_measured.sh [--first-seed N] [16]
#   16a, 16b the rows of measured structures, responses and cameras (figures 4 to 8 of closure.sh), and the size of every effect
#            adopted there   16c a drawn clip moved by the hover recorded in flight   16d a public clip filmed by hand
# Reports with pictures stay in build/figures/closure: measured_hover/loop, measured_hand/loop. The clip of 16d is in the set
# handheld_clip of tools/data.sh, looked for in HOVERMODAL_DATA, then in ./data.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/closure_measured.sh [--first-seed N] [FIGURE...]" "$@"
all_or_named 16
draws 16
out=build/figures/closure
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh hovermodal hovermodald hovermodal-validate
clip_s=60
. tools/figures/closure_foreign_clips.sh

# sizes REPORT...: of all adopted effects, those whose number is within three sigma of zero and that name no rival; "none" if there is none.
sizes() {
  python3 - "$@" <<'P'
import json, sys
shown = []
for path in sys.argv[1:]:
    for step in json.load(open(path))["steps"]:
        numbers = [p for p in step["parameters"].values() if p.get("sigma")]
        if numbers and all(abs(p["value"]) < 3 * p["sigma"] for p in numbers) and not step["rivals"]:
            shown.append(path.split("/")[-2] + ": " + step["effect"])
print(", ".join(shown) or "none")
P
}
former_rows() {
  local rows="$out/measured_rows.txt" n_ok n_miss reports name unclear
  tools/figures/closure.sh 4 5 6 7 8 >"$rows" || true
  grep -q '^# whole: ' "$rows" || { line 16a MISS "closure.sh did not reach its end" "all former rows" "measured data"; return; }
  sed -n 's/^\([4-8][a-z]* \)/# \1/p' "$rows"
  n_ok=$(grep -c '^[4-8][a-z]* ok ' "$rows" || true) n_miss=$(grep -cE '^[4-8][a-z]* (MISS|SKIP) ' "$rows" || true)
  judge 16a "$n_ok of $((n_ok + n_miss)) rows ok" "all former rows" "measured frames, beams, videos, loggers and a camera (closure.sh 4 to 8)" "$n_miss == 0 && $n_ok > 0"
  reports=()
  for name in paper shake published knex_clock knex_decay shake_input loggers phone; do
    [ ! -f "$out/$name/closure.json" ] || reports+=("$out/$name/closure.json")
  done
  unclear=$(sizes "${reports[@]}")
  judge 16b "adopted without rivals though not distinct from zero: $unclear; the shake table's frame: $(sed -n 's/^stopped: //p' "$out/shake.txt" | head -n 1)" \
    "the effect that cannot be told from zero is gone from the table or told so" "${#reports[@]} reports" \
    "$([ "$unclear" = none ] && echo 1 || echo 0) == 1"
}

# pictures REPORT...: how many files of these folders are pictures or pages.
pictures() { find "$@" -name '*.svg' -o -name '*.png' -o -name '*.html' | wc -l; }
# loop NAME CONFIG ARGUMENT...: all levels of the run $out/NAME; its table in $out/NAME_loop.txt.
loop() {
  "$bin/hovermodal" closeloop --run "$out/$1/run" --config "$2" "${@:3}" --report "$out/$1/loop" >"$out/$1_loop.txt" 2>"$out/$1_loop.log" ||
    { cat "$out/$1_loop.log" >&2; return 1; }
}
# found NAME: the table's rows in one line.
found() { awk '/^level/ { on = 1; next } /^$/ { on = 0 } on { $1 = $1; printf "%s%s", sep, $0; sep = "; " }' "$out/$1_loop.txt"; }

recorded_hover() {
  local what="a drawn clip of $clip_s s, 640 x 360, moved by the hover recorded in flight" seed=$first_seed last=$((first_seed + 40)) number
  if [ ! -f "$data/phantom4_hover/flight_10hz.csv" ]; then
    line 16c SKIP "no data at $data/phantom4_hover" "what is found, with pictures" "$what"
    return
  fi
  until "$bin/hovermodal-validate" closure-clip-foreign --first-seed "$seed" --duration "$clip_s" --flight "$data/phantom4_hover/flight_10hz.csv" |
    grep '^# recorded hover' >/dev/null; do
    seed=$((seed + 1))
    [ "$seed" -le "$last" ] || { line 16c MISS "no drawn flight is the recorded one" "what is found, with pictures" "$what"; return; }
  done
  foreign_clip measured_hover "$seed"
  local config=$out/measured_hover/config.yaml
  quietly "$bin/hovermodald" --config "$config" --set tracking.points_per_region=12 --set telemetry.lcm_url= --report "$out/measured_hover/run"
  rm -f "$out/measured_hover/clip.mp4"
  loop measured_hover "$config" --set tracking.points_per_region=12
  number=$(pictures "$out/measured_hover/run" "$out/measured_hover/loop")
  judge 16c "$(found measured_hover)" "what is found, with pictures" "$what, seed $seed; $number pictures and pages" "$number >= 2"
}
by_hand() {
  local clip="" folder what="a public clip filmed by hand, 480 x 360, 245 frames (github.com/linyihaolyh/VideoStabilization)" number
  for folder in "$data" data; do [ -n "$clip" ] || [ ! -f "$folder/handheld_clip/shaky.mp4" ] || clip=$(realpath "$folder/handheld_clip/shaky.mp4"); done
  if [ -z "$clip" ]; then
    line 16d SKIP "no data at $data/handheld_clip" "what is found, with pictures" "$what"
    return
  fi
  rm -rf "$out/measured_hand" && mkdir -p "$out/measured_hand"
  cat >"$out/measured_hand/config.yaml" <<Y
camera: {driver: file, source: $clip}
regions:
  - {name: wall, rect: [300, 130, 180, 40], role: background}
  - {name: lamp, rect: [300, 20, 80, 110]}
  - {name: hedge, rect: [250, 160, 220, 50]}
  - {name: paving, rect: [150, 220, 220, 110]}
spectrum: {segment: 64}
telemetry: {lcm_url: ""}
Y
  quietly "$bin/hovermodald" --config "$out/measured_hand/config.yaml" --report "$out/measured_hand/run"
  loop measured_hand "$out/measured_hand/config.yaml"
  number=$(pictures "$out/measured_hand/run" "$out/measured_hand/loop")
  judge 16d "$(structural "$out/measured_hand/run/modal.json") structural modes; $(found measured_hand)" "what is found, with pictures" \
    "$what; $number pictures and pages" "$number >= 2"
}
# structural MODAL_JSON: number of modes.
structural() { python3 -c 'import json, sys; print(sum(m["verdict"] == "structural" for m in json.load(open(sys.argv[1]))["modes"]))' "$1"; }

figure_16() {
  former_rows
  recorded_hover
  by_hand
}
run_figures "${figures[@]}"

#!/usr/bin/env bash
# The main job, end to end, without a camera: simulates the experiment of Yoon et al. 2017 (60 s of 1080p25 video of a
# shaken six-storey building, seen from a hovering drone), watches the clip with hovermodald, and shows the modes
# beside the paper's Table 1. The camera's readout time is not declared; at the end the loop is closed: what the model
# lacks is found, and the modes are shown before and after. Everything it makes lies in build/demo.
#   tools/demo.sh [--seconds S] [--seed N] [--out DIR] [--scene FILE]
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=60 seed=1 out=build/demo scene=tools/scenes/facade.yaml
while [ $# -gt 0 ]; do
  case $1 in
    --seconds) seconds=$2; shift 2 ;;
    --seed) seed=$2; shift 2 ;;
    --out) out=$2; shift 2 ;;
    --scene) scene=$2; shift 2 ;;
    *) echo "usage: tools/demo.sh [--seconds S] [--seed N] [--out DIR] [--scene FILE]" >&2; exit 2 ;;
  esac
done

tools/setup.sh
echo "== building"
tools/build.sh hovermodald hovermodal
bin=build/release/bin

echo "== simulating $seconds s of video (seed $seed)"
"$bin/hovermodal" simulate --scene "$scene" --duration "$seconds" --seed "$seed" --out "$out"

# A record of 30 s contains little more than one segment of 512 samples; half that segment gives five.
segment=512
[ "${seconds%.*}" -ge 45 ] || segment=256
echo "== watching the clip"
"$bin/hovermodald" --config "$out/config.yaml" --set telemetry.lcm_url= --set spectrum.segment=$segment --report "$out"

# The same identification on the true floor motion: the result of a perfect camera.
"$bin/hovermodal" identify --series "$out/truth_displacements.csv" --base base --segment $segment --report "$out/true_motion" >/dev/null
echo "== modes"
"$bin/hovermodal" compare --result "$out/modal.json" --reference "$out/true_motion/modal.json" --truth "$out/truth.json" --paper
echo
echo "open:     $out/report.html"
echo "modes:    $out/modal.json"
echo "clip:     $out/clip.mp4, its truth $out/truth.json, its configuration $out/config.yaml"
echo "pictures: $(cd "$out" && ls ./*.png ./*.svg 2>/dev/null | sed "s|^\./|$out/|" | paste -sd' ')"
echo
echo "== closing the loop: what the model lacks, and the modes before and after"
"$bin/hovermodal" closeloop --run "$out" --config "$out/config.yaml" --reference "$out/true_motion/modal.json"

#!/usr/bin/env bash
# The figures of real footage: never wrong without a word. One line a figure.
#   tools/figures/footage.sh [--quick] [--first-seed N] [FIGURE...]
# FIGURE: some of 1 2 3 4 5 6 (default: all).
#   1 eight damaged versions of the demo's clip   2 covered regions and glitches   3 telemetry in or beside the clip
#   4 short records and noise   5 proposed regions   6 speed of the reader of video
# --quick: a clip of 30 s in figure 1, fewer seeds in 2 and 4, two scenes in 5.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/footage.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
all_or_named 1 2 3 4 5 6
out=build/figures/footage
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh hovermodald hovermodal hovermodal-validate
. tools/figures/footage_clips.sh
. tools/figures/footage_telemetry.sh
. tools/figures/footage_regions.sh
. tools/figures/footage_signal.sh

run_figures "${figures[@]}"

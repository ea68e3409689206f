#!/usr/bin/env bash
# The figures of real footage: never wrong without a word. One line a figure.
#   tools/figures/footage.sh [--quick] [--first-seed N] [FIGURE...]
# FIGURE: some of 2 4 (default: all).
#   2 covered regions and glitches   4 short records and noise
# --quick: fewer seeds.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
arguments "2 4" "$@"
out=build/figures/footage
mkdir -p "$out"
tools/setup.sh
. tools/figures/footage_signal.sh

run_figures "${figures[@]}"

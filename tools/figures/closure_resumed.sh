#!/usr/bin/env bash
# Figures 11 to 14 of closing the loop, as tools/figures/closure.sh has them, in runs that may be interrupted: the records
# of every four seeds are kept, and the next run computes only those that are missing.
#   tools/figures/closure_resumed.sh [--quick] [--seeds N] [--first-seed N] [FIGURE...]
# FIGURE: some of 11 12 13 14 (default: all). The records stay in build/figures/closure_resumed, in a folder named after
# the content of every file that the figure measures: a change of one of them begins anew.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/closure_resumed.sh [--quick] [--seeds N] [--first-seed N] [FIGURE...]" "$@"
seeds=300 few=20 # the cases of closure.sh
[ -z "$quick" ] || seeds=30 few=2
[ -z "$n_seeds" ] || seeds=$n_seeds few=$n_seeds
all_or_named 11 12 13 14
out=build/figures/closure_resumed
tools/setup.sh
quietly tools/build.sh hovermodal-validate

validate() { # NAME SEEDS ...: the table of a self-test, in $out/NAME.txt
  local name=$1 n=$2 kept first last end=$((first_seed + $2 - 1))
  shift 2
  kept=$out/$name-$(python3 tools/figures/tables.py --rooms "closure_$figure" | sha256sum | cut -c1-16)
  mkdir -p "$kept"
  : >"$kept/all"
  for ((first = first_seed; first <= end; first += 4)); do
    last=$((first + 3 < end ? first + 3 : end))
    if [ ! -e "$kept/$first-$last" ]; then
      echo "$name: seeds $first-$last of $first_seed-$end" >&2
      "$bin/hovermodal-validate" "$name" --first-seed "$first" --seeds "$((last - first + 1))" --threads "$(nproc)" "$@" >"$kept/new"
      mv "$kept/new" "$kept/$first-$last"
    fi
    cat "$kept/$first-$last" >>"$kept/all"
  done
  cp "$kept/all" "$out/$name.txt"
}
. tools/figures/closure_foreign.sh
. tools/figures/closure_series_tracked.sh
run_figures "${figures[@]}"

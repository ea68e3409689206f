#!/usr/bin/env bash
# The figures of structural models of any kind: accuracy, effects, places, measured structures, tension. One line a figure.
#   tools/figures/structures.sh [--quick] [--seeds N] [--first-seed N] [FIGURE...]
# FIGURE: some of 1 2 3 4 5 6 (default: all). SKIP where measured data (HOVERMODAL_DATA) are absent; figure 4 is compared
# with SciPy where Debian's python3-scipy is installed.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/structures.sh [--quick] [--seeds N] [--first-seed N] [FIGURE...]" "$@"
all_or_named 1 2 3 4 5 6
draws 2 3 4 6
seeds=100
[ -z "$quick" ] || seeds=6
[ -z "$n_seeds" ] || seeds=$n_seeds
out=build/figures/structures
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh hovermodal hovermodald hovermodal-validate

# --- 1: kinds against closed-form solutions ----------------------------------------------------------------------------
figure_1() {
  "$bin/hovermodal-validate" structure-kinds >"$out/kinds.txt"
  local n=0 kind structure against modes worst
  while IFS=$'\t' read -r _ kind structure against modes worst; do
    n=$((n + 1))
    judge "1_$n" "largest error of $modes frequencies $worst" \
      "$([ "$against" = "closed form" ] && echo "closed-form solutions: 1e-8" || echo "against dense matrices: 1e-8")" \
      "$kind: $structure, against $against" "$worst <= 1e-8"
  done < <(grep '^kind' "$out/kinds.txt")
  judge 1 "$n comparisons" "kinds against closed-form solutions (uniform cantilever, simply supported and continuous beam, string, two-span on springs): 1e-8; against dense matrices for frame2d, matrices" \
    "cases compared" "$n >= 18"
}

# --- 2: every kind with every effect ------------------------------------------------------------------------------------
figure_2() {
  local n_each=20
  [ -z "$quick$n_seeds" ] || n_each=$seeds
  "$bin/hovermodal-validate" structure-effects --first-seed "$first_seed" --seeds "$n_each" --threads "$(nproc)" >"$out/effects.txt"
  local kind effect n alone rival nothing place intervals inside before after instead all=0 held=0
  while IFS=$'\t' read -r _ kind effect n alone rival nothing place intervals inside before after instead; do
    all=$((all + intervals)) held=$((held + inside))
    judge "2_${kind}_$effect" "named $alone and nothing else, another with it among the rivals $rival, nothing $nothing of $n; at its place $place, 95 % interval holds in $inside of $intervals; held out $before -> $after % (medians); instead:$instead" \
      "named and nothing else in >= 90 %, rivals right where the modes cannot tell" "$effect in a $kind, 3 to 6 modes at 5 to 8 places, $(seeds_of "$n")" \
      "$alone + $rival >= 0.9 * $n"
  done < <(grep '^named' "$out/effects.txt")
  while IFS=$'\t' read -r _ effect n alone rival inside before after instead; do
    all=$((all + alone)) held=$((held + inside))
    judge "2_damping_$effect" "reported $alone and nothing else, not distinguished with it among those left $rival of $n; 95 % interval holds in $inside of $alone; held out, of the ratio, $before (a constant one) -> $after % (medians); instead:$instead" \
      "named and nothing else in >= 90 %, rivals right where the modes cannot tell" "damping $effect in towers and buildings, ratios known to 5 to 20 %, 3 to 6 modes, $(seeds_of "$n")" \
      "$alone + $rival >= 0.9 * $n"
  done < <(grep '^damping' "$out/effects.txt")
  judge 2_interval "$held of $all sizes" "95 % interval holds in 90-98 %" "all kinds and effects together, where named at its place" \
    "$held >= 0.9 * $all && $held <= 0.98 * $all"
}

# --- 3: where --------------------------------------------------------------------------------------------------------
figure_3() {
  "$bin/hovermodal-validate" structure-where --first-seed "$first_seed" --seeds "$seeds" --threads "$(nproc)" >"$out/where.txt"
  local loss n told near exact other share
  while IFS=$'\t' read -r _ loss n told near exact other; do
    if [ "$loss" = 0 ]; then
      judge 3_none "$told of $n reported" "no damage: at most 3 of 300 told" "structures without damage, $(seeds_of "$n")" "$told <= 0.01 * $n"
      continue
    fi
    share=$(awk -v loss="$loss" 'BEGIN { split("5 10 20 40", l); split("50 80 95 99", s); for (i in l) if (l[i] == loss) print s[i] }')
    judge "3_$loss" "within one element $near of $n (at the very one $exact, another effect reported as well or instead $other)" \
      "one of ten storeys or elements loses 5, 10, 20, 40 %: found within one element in 50, 80, 95, 99 % (frequencies 0.1 %, shapes 1 %)" \
      "loss of $loss % in frames, towers and beams, 6 modes at 10 places, $(seeds_of "$n")" "$near >= 0.01 * $share * $n"
  done < <(grep '^where' "$out/where.txt")
}

# --- 4: a large model ------------------------------------------------------------------------------------------------
figure_4() {
  local wall=$out/wall n groups soft factor seconds kilobytes found theirs ours worst core
  core=$(python3 -c 'import os; print(min(os.sched_getaffinity(0)))')
  rm -rf "$wall" && mkdir -p "$wall"
  taskset -c "$core" "$bin/hovermodal-validate" structure-large --first-seed "$first_seed" --report "$wall" >"$wall/large.txt"
  read -r _ n groups soft factor < <(grep '^large' "$wall/large.txt")
  # On one core, with the time and the peak of resident memory of the process.
  read -r seconds kilobytes < <(python3 - "$bin/hovermodal" "$wall" <<'PY'
import os, resource, subprocess, sys, time
binary, wall = sys.argv[1:]
core = {min(os.sched_getaffinity(0))}
begin = time.monotonic()
with open(f"{wall}/loop.txt", "w") as text:
    subprocess.run([binary, "closeloop", "--structure", f"{wall}/wall.yaml", "--reference", f"{wall}/modes.csv", "--report", f"{wall}/loop"],
                   stdout=text, stderr=subprocess.STDOUT, preexec_fn=lambda: os.sched_setaffinity(0, core))
print(f"{time.monotonic() - begin:.0f}", resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
PY
  )
  found=$(python3 -c '
import json, sys
c = json.load(open(sys.argv[1]))
print("; ".join(e["effect"] + " " + e["meaning"] for e in c["steps"]) or "nothing")' "$wall/loop/closure.json" 2>/dev/null || echo "no result")
  judge 4 "$n degrees of freedom, $groups groups, 12 modes: $seconds s, $((kilobytes / 1024)) MB on one core; found: $found (true: group $soft at $factor)" \
    "one loop within ten minutes and 4 GB on one core" "matrices of 10^5 degrees of freedom" "$n >= 100000 && $seconds <= 600 && $kilobytes <= 4194304"
  if /usr/bin/python3 -c 'import scipy.sparse.linalg' 2>/dev/null; then
    read -r theirs ours worst < <(taskset -c "$core" /usr/bin/python3 tools/figures/structures_eigsh.py "$wall/k.mtx" "$wall/m.mtx" "$wall/large.txt")
    line 4_scipy beside "eigsh $theirs s, ours $ours s; frequencies differ by $worst at most (relative)" "none" \
      "beside SciPy's eigsh for the eigenproblem: 12 modes of $n degrees of freedom, shift 0, on one core"
  else
    line 4_scipy SKIP "no python3-scipy" "none" "beside SciPy's eigsh for the eigenproblem"
  fi
}

# --- 5: measured structures ------------------------------------------------------------------------------------------
. tools/figures/structures_measured.sh

# --- 6: tension --------------------------------------------------------------------------------------------------------
figure_6() {
  "$bin/hovermodal-validate" structure-tension --first-seed "$first_seed" --seeds "$seeds" --threads "$(nproc)" >"$out/tension.txt"
  local duration n found inside sigma most rms worst scaled least_modes most_modes effects
  while IFS=$'\t' read -r _ duration n found inside sigma most rms worst scaled least_modes most_modes effects; do
    judge "6_${duration}s" "$inside of the $found stays with a tension (of $n) within 1.96 sigma; error $rms % rms, $worst % at most, $scaled sigma rms; $least_modes to $most_modes modes, an effect reported in $effects" \
      "within its 95 % interval in 90-98 %" "tension of a simulated stay cable filmed at 50 fps, $duration s, $(seeds_of "$n")" \
      "$inside >= 0.9 * $found && $inside <= 0.98 * $found"
    judge "6_${duration}s_sigma" "sigma $sigma % in the median, $most % at most, none for $((n - found)) of $n" "sigma <= 1 % from 60 s" \
      "the same" "$most <= 1 && $found == $n"
  done < <(grep '^tension' "$out/tension.txt")
}

run_figures "${figures[@]}"

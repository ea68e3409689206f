#!/usr/bin/env bash
# Every mode that measured records hold, and what the window does to it. One line a figure.
#   tools/figures/trust_measured.sh [--quick] [--first-seed N] [FIGURE...]      FIGURE: some of 6 6b (default: all)
# --quick and --first-seed are taken and change nothing: measured records are what they are. SKIP where the data are absent.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/trust_measured.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
all_or_named 6 6b
out=build/figures/trust_measured
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh hovermodal
measured() { python3 -B tools/figures/measured_windows.py "$1" "$bin/hovermodal" "$data"; }

# --- 6: measured records, one by one and merged ---------------------------------------------------------------------------
figure_6() {
  local name found beside stated which rms n
  if [ ! -d "$data/five_storey_frame" ]; then line 6 SKIP "no $data/five_storey_frame" "five-storey set-ups one by one and merged now with sigma" "-" && return; fi
  measured setups >"$out/setups.tsv"
  while IFS=$'\t' read -r _ name found beside stated; do
    judge "6.${name#frame }" "$found of 8 published, $beside others below 10 Hz, sigma of $stated" "five-storey set-ups one by one and merged now with sigma" \
      "$name" "$found == 8 && $beside == 0 && $stated == 8"
  done < <(grep '^setup	' "$out/setups.tsv")
  while IFS=$'\t' read -r _ which rms n; do
    line "6.scatter.$which" ok "$rms of the stated sigma, rms, $n degrees of freedom" "how far set-ups scatter over what they state" "four set-ups, about their weighted mean"
  done < <(grep '^scatter	' "$out/setups.tsv")
  line 6.others SKIP "see identification_measured.sh and main_job_filmed.sh" "shear frames with and without input; forks" "known answers"
}

# --- 6b: the window ---------------------------------------------------------------------------------------------------------
# spreads OPTION QUANTITY: modes, those that are found with every window and spread by at most two sigma.
spreads() {
  awk -F'\t' -v option="$1" -v which="$2" '$1 == "window" && $3 == option && $5 == which { n++; k += $6 == $7 && $8 <= 2 } END { print n + 0, k + 0 }' "$out/windows.tsv"
}
figure_6b() {
  local option which n kept name factor modes same wanted
  if [ ! -d "$data/five_storey_frame" ]; then line 6b SKIP "no $data" "spread <= 2 stated sigma in 95 %" "-" && return; fi
  measured windows >"$out/windows.tsv"
  for option in block-rows segment; do
    for which in frequency_hz damping_ratio; do
      read -r n kept < <(spreads "$option" "$which")
      judge "6b.$option.${which%%_*}" "$kept of $n modes" "spread <= 2 stated sigma in 95 %" \
        "measured and published records, seven windows over a factor of 8, largest minus smallest" "$n > 0 && $kept >= 0.95 * $n"
    done
  done
  line 6b.drawn SKIP "not measured" "f and zeta of every mode of figure 1 over a factor 8; low modes of 3 to 30 periods a segment" "drawn records"
  if ! /usr/bin/python3 -c 'import scipy.io' 2>/dev/null; then line 6b.rate SKIP "no python3-scipy" "records at 1, 10, 100 times the needed rate: the same modes by default" "-" && return; fi
  /usr/bin/python3 -B tools/figures/measured_windows.py rates "$bin/hovermodal" "$data" "$out" >"$out/rates.tsv"
  while IFS=$'\t' read -r _ name factor modes; do
    [ "$factor" != 1 ] || wanted=$modes
    same=$(awk -v a="$wanted" -v b="$modes" 'BEGIN { n = split(a, x, " "); m = split(b, y, " "); for (i = 1; i <= n; i++) { e = x[i] - y[i]; k += (e < 0 ? -e : e) < 0.01 * x[i] } print k + 0 == n && n == m }')
    judge "6b.rate.$name.$factor" "${modes:-none} Hz" "records at 1, 10, 100 times the needed rate: the same modes by default" "$name, resampled by $factor" "$same == 1"
  done <"$out/rates.tsv"
}
run_figures "${figures[@]}"

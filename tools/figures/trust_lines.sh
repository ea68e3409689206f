#!/usr/bin/env bash
# Lines of machines and rotors beside modes: what they are called, and what they do to the modes. One line a figure.
#   tools/figures/trust_lines.sh [--quick] [--first-seed N] [FIGURE...]      FIGURE: 5 (default: all)
# --quick takes five seeds. The table stays in build/figures/trust_lines. Records of 120 s as in trust.sh, on a shaken base and
# in the wind: a steady force on the uppermost storey, 0.5 to 30 % from a mode below half the rate, and a camera that rotors of
# 60 to 200 Hz shake, each with an rms of 1.0 and of 0.3 of that mode's.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/trust_lines.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
all_or_named 5
seeds=50
[ -z "$quick" ] || seeds=5
out=build/figures/trust_lines
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh hovermodal-validate
flight=()
if [ -f "$data/phantom4_hover/flight_10hz.csv" ]; then flight=(--flight "$data/phantom4_hover/flight_10hz.csv"); fi

# lines KIND RATIO: records, lines called lines, called modes, absent.
lines() {
  awk -F'\t' -v kind="$1" -v ratio="$2" '$1 == "trust-line" && $4 == kind && $5 == ratio { n++; c[$8]++ }
    END { print n + 0, c["line"] + 0, c["mode"] + 0, c["absent"] + 0 }' "$out/lines.tsv"
}
figure_5() {
  local kind ratio share n called modes absent lost worst beside
  "$bin/hovermodal-validate" trust-lines --first-seed "$first_seed" --seeds "$seeds" --duration 120 --threads "$(nproc)" "${flight[@]}" >"$out/lines.tsv"
  for kind in machine rotor; do
    for ratio in 1 0.3; do
      share=0.95
      [ $ratio = 1 ] || share=0.85
      read -r n called modes absent < <(lines $kind $ratio)
      judge "5.$kind.$ratio" "$called of $n; $modes called modes, $absent without a pole of their own" "classified as such in 95 / 85 %" \
        "$([ $kind = machine ] && echo "harmonics 0.5-30 % apart in frequency" || echo "rotor lines 60-200 Hz"), $ratio of the mode beside" "$n > 0 && $called >= $share * $n"
    done
  done
  read -r n lost < <(awk -F'\t' '$1 == "trust-line" { n += 6; lost += $9 } END { print n + 0, lost + 0 }' "$out/lines.tsv")
  judge 5.modes "$lost of $n" "a true mode so classified in at most 1 of 300" "six modes a record, all records" "$n > 0 && $lost <= $n / 300"
  read -r n beside worst < <(awk -F'\t' '$1 == "trust-line" && $10 != "nan" { n++; k += $10 <= 0.002; if ($10 > w) w = $10 } END { print n + 0, k + 0, 100 * w }' "$out/lines.tsv")
  judge 5.beside "unharmed in $beside of $n, worst $worst %" "frequency of the mode beside unharmed (0.2 %)" \
    "against the same record without the line, where the mode is found in both" "$n > 0 && $beside == $n"
}
run_figures "${figures[@]}"

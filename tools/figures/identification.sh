#!/usr/bin/env bash
# The figures of the identification: spectra, measured records, simulated records of known truth, cost. One line a figure.
#   tools/figures/identification.sh [--quick] [--first-seed N] [FIGURE...]      FIGURE: some of 1 ... 10 (default: all)
# --quick takes a tenth of the seeds, and little of the clock. Figures 1, 9, 10 come from identification_speed.sh, 2-4 from
# identification_measured.sh, 5-8 from `hovermodal-validate`, whose tables stay in build/figures/identification; their
# "-drawn" lines hold the same bars to records whose camera, structure and noise are drawn from the seed.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/identification.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
all_or_named 1 2 3 4 5 6 7 8 9 10
many=200 seeds=100 few=20
[ -z "$quick" ] || many=20 seeds=10 few=4
out=build/figures/identification
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh hovermodal hovermodal-validate

part() { # SCRIPT FIGURE: its lines; its misses count here
  local text
  text=$("tools/figures/$1" ${quick:+--quick} --first-seed "$first_seed" "$2" 2>&1) || true
  grep -E '^[0-9]' <<<"$text" || { echo "$text" >&2; line "$2" MISS "the script failed" "-" "tools/figures/$1 $2"; }
  misses=$((misses + $(grep -cE '^[0-9a-z.]+ MISS ' <<<"$text" || true)))
}
check() { # NAME SEEDS ...: the table of a self-test
  local name=$1 n=$2
  shift 2
  "$bin/hovermodal-validate" "$name" --first-seed "$first_seed" --seeds "$n" --threads "$(nproc)" "$@" >"$out/$name.txt" ||
    echo "# validate $name failed" # its lines are then MISS
}
# table NAME FILTER PROGRAM END: awk over the rows of a table that pass the filter. num(x) is a number of a row; if one is not
# a number, nan is printed for all.
table() {
  awk -F'\t' "function size(x) { return x < 0 ? -x : x }
    function num(x) { if (x !~ /^[-+]?[0-9]/) none = 1; return x + 0 }
    $2 { n++; $3 }
    END { if (none || !n) { print \"nan nan nan nan nan nan\"; exit } $4 }" "$out/$1.txt"
}

figure_1() { part identification_speed.sh 1; }
figure_2() { part identification_measured.sh 2; }
figure_3() { part identification_measured.sh 3; }
figure_4() { part identification_measured.sh 4; }
figure_9() { part identification_speed.sh 9; }
figure_10() { part identification_speed.sh 10; }

# --- 5: bias, scatter, intervals --------------------------------------------------------------------------------------
figure_5() {
  check bias "$many"
  bias_lines bias "" "60 Hz, six storeys, damping 1 %" '$n == 6'
  bias_lines bias-drawn -drawn "camera, structure and noise drawn" '$n >= 4'
}
bias_lines() { # TABLE SUFFIX WHAT CONDITION-ON-ROWS
  local n f z low high rows clear="\$1 == \"$1\" && \$2 == \"corrected\" && \$5 == \"clear\""
  read -r n f z _ < <(table bias "$clear" \
    'a = size(num($7)) - 2 * num($8); b = size(num($9)) - 2 * num($10); if (n == 1 || a > f) f = a; if (n == 1 || b > z) z = b' 'print n, f, z')
  rows=${4/\$n/$n}
  judge "5a$2" "$n modes, beyond two standard errors f at most $f %, damping at most $z %" "0.02 %, 3 %" \
    "mean error over records of 300 s, $3, $(seeds_of "$many")" "$rows && $f <= 0.02 && $z <= 3"
  read -r n f z _ < <(table bias "$clear" 'if (num($12) > f) f = $12; if (num($13) > z) z = $13' 'print n, f, z')
  judge "5b$2" "f at most $f, damping at most $z" "1.25" "their scatter over the least possible" "$rows && $f <= 1.25 && $z <= 1.25"
  read -r n low high _ < <(table bias "\$1 == \"$1\" && \$2 == \"corrected\"${2:+ && \$5 == \"clear\"}" \
    'for (i = 14; i <= 15; i++) { if (low == "" || num($i) < low) low = $i; if (num($i) > high) high = $i }' 'print n, low, high')
  read -r f z _ < <(table bias "\$1 == \"$1-all\" && \$2 == \"corrected\"" 'f = num($5); z = num($6)' 'print f, z')
  judge "5c$2" "pooled $f and $z %, each mode $low ... $high %" "pooled 93-97 %, each 90-98 %" \
    "truth within the stated 95 % intervals, f and damping" \
    "$rows && $f >= 93 && $f <= 97 && $z >= 93 && $z <= 97 && $low >= 90 && $high <= 98"
  line "5d$2" beside "$(table bias "\$1 == \"$1\" && \$2 == \"uncorrected\" && \$5 == \"clear\"" \
    's = s sprintf("%s%s: found %d, damping %+.0f %%", n > 1 ? "; " : "", $3, $6, $9)' 'print s')" \
    "none" "the same without dividing the window out, by ${2:+number of the }mode${2:-, Hz}"
}

# --- 6: losses ----------------------------------------------------------------------------------------------------------
figure_6() {
  check losses "$few"
  local suffix n lost worst
  for suffix in "" -drawn; do
    read -r n lost worst _ < <(table losses "\$1 == \"losses$suffix\" && \$2 == \"bridged\" && \$4 > 0" \
      'lost += $7 - $6; if (num($9) > w) w = $9' 'print n, lost, w')
    judge "6$suffix" "worst $worst %, $lost modes lost" "0.3 %, none lost" \
      "modes 1-3 against the estimate without losses: 1, 5, 30 % of samples, or of whole frames, lost; $(seeds_of "$few")" \
      "$n == 18 && $worst <= 0.3 && $lost == 0"
  done
}

. tools/figures/identification_verdicts.sh
run_figures "${figures[@]}"

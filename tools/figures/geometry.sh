#!/usr/bin/env bash
# The figures of the geometry: flights of known truth from tracks (and one from pixels) to modes. One line a figure.
#   tools/figures/geometry.sh [--quick] [FIGURE...]      --quick takes 3 seeds for 20 and shorter records, and draws no
# clip; FIGURE: some of 1 ... 7 (default: all).
# Tables and pictures stay in build/figures/geometry. Errors are those against the identification of the true motion of
# the same record; beside them stand the errors against the true parameters, in the least possible scatter
# sqrt(zeta / (2 pi f T)).
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
seeds=20 few=5 clips=3 shorter=()
[ "${1:-}" != --quick ] || { seeds=3 few=1 clips=0 shorter=(--duration 120) && shift; }
figures=("${@:-}")
[ -n "${figures[0]}" ] || figures=(1 2 3 4 5 6 7)
out=build/figures/geometry
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh hovermodal

flight=$data/phantom4_hover/flight_10hz.csv
moved_by="hover recorded in flight" use_flight=(--flight "$flight")
if [ ! -f "$flight" ]; then
  line 0 SKIP "no data at $flight" "-" "recorded hover: the hover model moves the camera instead"
  moved_by="modelled hover" use_flight=()
fi

check() { # NAME SEEDS ...: the table of a self-test
  local name=$1 n=$2
  shift 2
  "$bin/hovermodal" selftest "$name" --seeds "$n" --threads "$(nproc)" "${use_flight[@]}" "$@" >"$out/$name.txt"
}
row() { # FIGURE CASE WAY: columns 4 on of its line
  awk -F'\t' -v c="$2" -v w="$3" '$2 == c && $3 == w { for (i = 4; i <= NF; ++i) printf "%s ", $i }' "$out/$1.txt"
}
read_row() { # FIGURE CASE WAY: into variables
  read -r n complete f_median f_worst z_median z_worst mac_median mac_worst found fewest all f_rms f_far z_rms z_far \
    n_false ambiguous wrong <<<"$(row "$@")"
  : "${n:=0}" "${complete:=0}" "${f_median:=nan}" "${f_worst:=nan}" "${z_worst:=nan}" "${mac_worst:=0}" "${fewest:=0}" "${all:=0}"
}
errors() { # of the row that was read
  echo "$complete of $n records complete, f median $f_median worst $f_worst %, MAC median $mac_median worst $mac_worst"
}
truth() { # of the row that was read
  echo "against the true parameters f rms $f_rms worst $f_far, damping rms $z_rms worst $z_far of the least scatter"
}
all_finite() { case " $* " in *nan*) return 1 ;; esac; }
bar() { # NUMBER MEASURED BAR WHAT CONDITION: a comparison with nan is no pass
  if all_finite "$f_median" "$f_worst" "$z_worst" "$mac_worst"; then judge "$@"; else line "$1" MISS "$2" "$3" "$4"; fi
}

# --- 1: the paper's experiment ------------------------------------------------------------------------------------------
figure_1() {
  check geometry "$seeds" "${shorter[@]}"
  local way
  for way in raw scale rho-1 paper no-witness; do
    read_row geometry paper-300s "$way"
    line 1a beside "$(errors); found median $found fewest $fewest of $all; $(truth)" "none" "ablation: $way"
  done
  read_row geometry paper-300s ours
  bar 1a "$(errors); $(truth)" "0.2 % median, 0.4 % worst, MAC 0.999" \
    "ours, modes 1-3, tracks at 25 fps, readout 0.7 of a frame, $moved_by, $n seeds" \
    "$complete == $n && $f_median <= 0.2 && $f_worst <= 0.4 && $mac_worst >= 0.999"
  judge 1b "median $found, fewest $fewest of $all; per record $n_false that are no mode" "5 of 6 (goal: 6)" \
    "modes found in the same records" "$fewest >= 5"
  figure_1_pixels
  figure_1_table
}
figure_1_pixels() {
  if [ "$clips" -eq 0 ]; then line 1c SKIP "--quick draws no clip" "0.2 % median, 0.4 % worst, MAC 0.999" "60 s of rendered 1080p25"; return; fi
  check geometry-pixels "$clips" --report "$out"
  read_row geometry-pixels paper-60s ours
  bar 1c "$(errors); found median $found of $all; $(truth)" "0.2 % median, 0.4 % worst, MAC 0.999" \
    "60 s of rendered 1080p25 through the service, $n seeds (a clip takes a minute)" \
    "$complete == $n && $f_median <= 0.2 && $f_worst <= 0.4 && $mac_worst >= 0.999"
  read_row geometry-pixels paper-60s paper
  line 1c beside "$(errors)" "none" "the same by the paper's chain"
}
figure_1_table() {
  check table1 "$few" "${shorter[@]}" --report "$out/table1"
  local sensor
  for sensor in stationary paper ours; do
    line 1d beside "$(awk -F'\t' -v s="$sensor" '$1 == "table1" && $2 == s { out = out sprintf("%smode %d found in %d of %d, error %s %%, MAC %s %%", n++ ? "; " : "", $3, $5, $4, $7, $9) } END { print out }' "$out/table1.txt")" \
      "none" "Table 1 of the paper simulated, medians against the accelerometers: $sensor"
  done
  line 1d beside "$(awk -F'\t' '$1 == "table1-published" { out = out sprintf("%smode %d error %s and %s %%, MAC %s and %s %%", n++ ? "; " : "", $2, $8, $9, $6, $7) } END { print out }' "$out/table1.txt")" \
    "none" "the same as published: stationary camera and UAV; Figures 6 to 9 in $out/table1"
}

# --- 2: wind ------------------------------------------------------------------------------------------------------------
figure_2() {
  check wind "$seeds" "${shorter[@]}"
  read_row wind gusts-5deg ours
  bar 2 "$(errors); $(truth)" "0.3 % median, MAC 0.995" "gusts of 5 degrees, with background points, $n seeds" \
    "$complete == $n && $f_median <= 0.3 && $mac_worst >= 0.995"
  read_row wind gusts-5deg ours-no-background
  line 2 beside "$(errors); $(truth)" "none" "the same without background points"
  read_row wind gusts-5deg paper
  line 2 beside "$(errors); $(truth)" "none" "the same by the paper's chain"
}

# --- 3: a tall structure ------------------------------------------------------------------------------------------------
figure_3() {
  check low-frequency "$([ "$clips" -gt 0 ] && echo "$seeds" || echo "$few")"
  read_row low-frequency chimney-900s ours
  bar 3 "found $complete of $n, f median $f_median worst $f_worst %, damping median $z_median worst $z_worst %; $(truth)" \
    "0.5 %, 25 %, all" "0.32 Hz under the drift of the $moved_by, 900 s" \
    "$complete == $n && $f_worst <= 0.5 && $z_worst <= 25"
  read_row low-frequency chimney-900s paper
  line 3 beside "found $complete of $n, f median $f_median worst $f_worst %, damping median $z_median worst $z_worst %" "none" \
    "the same by the paper's chain"
}

# --- 4: readout ---------------------------------------------------------------------------------------------------------
figure_4() {
  local what="readout over -1 ... 1 of a frame, from tracks of 300 s under the hover" bar="0.02 of a frame, 2.5 sigma"
  if ! "$bin/hovermodal" selftest --help | grep -q '^ *readout:'; then
    line 4a SKIP "no online estimate of the readout in this build" "$bar" "$what"
    return
  fi
  "$bin/hovermodal" selftest readout --seeds "$seeds" --threads "$(nproc)" >"$out/readout.txt"
  # readout, true frames, seconds, records, with an estimate, mean, deviation, worst error, stated, worst in sigmas, ...
  read -r rows missing worst sigmas < <(awk -F'\t' '$1 == "readout" && $3 == 300 { n++; missing += $4 - $5; if ($8 > w) w = $8; if ($10 > s) s = $10 }
    END { print n + 0, missing + 0, w + 0, s + 0 }' "$out/readout.txt")
  judge 4a "worst $worst of a frame, worst $sigmas of the stated deviation, $missing records without an estimate" "$bar" \
    "$what, $rows readouts" "$rows > 0 && $missing == 0 && $worst <= 0.02 && $sigmas <= 2.5"
  figure_4_measured
}
# A phone in a moving car. Nothing tells the true readout; that the program which came with the clip takes a whole frame
# time (33.312 ms, with a focal length of 574.4 px) is printed beside it.
figure_4_measured() {
  local clip=$data/phone_rolling_shutter_gyro
  local what="measured clip, phone in a car, gyro beside it" bar="sigma 1.5 ms, halves within 2.5 sigma, less residual with the readout than with none"
  if [ ! -d "$clip/frames" ]; then
    line 4b SKIP "no data at $clip" "$bar" "$what"
    return
  fi
  "$bin/hovermodal" readout --clip "$clip/frames" --stamps "$clip/framestamp.txt" --first-stamp 99 --gyro "$clip/gyro.txt" \
    --focal-px 574.4 --ignore 0,400,800,200 --picture "$out/readout_measured.svg" >"$out/readout_measured.txt" || true
  local ms=nan sigma=nan row=nan row_sigma=nan before=nan after=nan apart=nan
  read -r ms sigma row row_sigma before after apart < <(awk -F'\t' '
    $1 == "readout_ms" { ms = $2; s = $3 } $1 == "row_delay_us" { row = $2; rs = $3 } $1 == "held_out_rms_px" { b = $2; a = $3 }
    $1 == "half_readout_ms" { v[++n] = $2; w[n] = $3 }
    END { if (n == 2) { d = v[1] - v[2]; z = (d < 0 ? -d : d) / sqrt(w[1] ^ 2 + w[2] ^ 2); print ms, s, row, rs, b, a, z } }' "$out/readout_measured.txt") || true
  if all_finite "$ms" "$sigma" "$before" "$after" "$apart"; then
    judge 4b "readout $ms +- $sigma ms, row delay $row +- $row_sigma us; halves $apart sigma apart; held-out frames $before px with none, $after px with it" \
      "$bar" "$what" "$sigma <= 1.5 && $sigma > 0 && $apart <= 2.5 && $after < $before"
    line 4b beside "$(awk "BEGIN { printf \"%.1f\", ($ms - 33.312) / $sigma }") sigma from it" "none" \
      "33.312 ms, a whole frame time, which the clip's own program assumes"
  else
    line 4b MISS "no estimate" "$bar" "$what"
  fi
}

# --- 5: a bridge deck ---------------------------------------------------------------------------------------------------
figure_5() {
  check deck "$seeds" "${shorter[@]}"
  local case
  for case in landscape turned; do
    read_row deck $case ours
    bar 5a "$(errors); $(truth)" "0.3 %" "deck, 2.1 and 6.4 Hz, camera $case, $n seeds" "$complete == $n && $f_worst <= 0.3"
    read_row deck $case paper
    line 5a beside "$(errors)" "none" "the same by the paper's chain"
  done
  read -r planned told ambiguous wrong < <(awk -F'\t' '$1 == "deck-mode" && $3 == "ours" && $4 > 15 {
    if ($2 == "turned") { p += $5 == "resolved"; t += $7; n += $6 } else { p += $5 ~ /^ambiguous/; a += $8; m += $6 } w += $9 }
    END { print p + 0, (n ? t / n : 0), (m ? a / m : 0), w + 0 }' "$out/deck.txt")
  judge 5b "turned: resolved in $(awk "BEGIN { print 100 * $told }") %; landscape: called ambiguous in $(awk "BEGIN { print 100 * $ambiguous }") %; certain and wrong $wrong" \
    "100 %, 100 %, never" "modes at 17.2 and 19.8 Hz at 30 fps, as planned for $planned of 4" \
    "$planned == 4 && $told == 1 && $ambiguous == 1 && $wrong == 0"
}

# --- 6: elevation -------------------------------------------------------------------------------------------------------
figure_6() {
  check elevation "$seeds" "${shorter[@]}"
  local way
  for way in paper one-scale plane-pose; do
    read_row elevation 30deg "$way"
    [ "$n" -gt 0 ] || continue
    line 6 beside "lowest MAC of modes 1-3 median $mac_median worst $mac_worst; $complete of $n records complete, f median $f_median worst $f_worst %" \
      "none" "30 degrees of elevation: $way"
  done
}

# --- 7: noise floor -----------------------------------------------------------------------------------------------------
figure_7() {
  check noise-floor "$few" "${shorter[@]}"
  local way
  for way in ours ours-no-background paper; do
    line 7 beside "$(awk -F'\t' -v w="$way" '$2 == w { s = s sprintf("%s%s %.4f mm %.4f px (white %.4f px, bound %.4f, camera known %.4f)", n++ ? "; " : "", $3, $5, $6, $8, $11, $9) } END { print s }' "$out/noise-floor.txt")" \
      "none" "a structure at rest, $moved_by: $way"
  done
}

for figure in "${figures[@]}"; do figure_$figure; done
[ "$misses" -eq 0 ]

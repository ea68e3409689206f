#!/usr/bin/env bash
# The figures of the identification on records that others measured or computed (the folder HOVERMODAL_DATA, its README
# says what they are). Fixed defaults: said are only rate, quantity, highest frequency and measured input. One line a
# figure; SKIP where the data are absent.
#   tools/figures/identification_measured.sh [FIGURE...]      FIGURE: some of 2 3 4 (default: all)
# --quick and --first-seed are taken and change nothing: measured records are what they are.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/identification_measured.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
all_or_named 2 3 4
out=build/figures/identification_measured
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh hovermodal

# identify NAME ARGUMENTS...: report in $out/NAME, text in $out/NAME.txt, modes in $out/NAME.modes.
identify() {
  local name=$1
  shift
  rm -rf "${out:?}/$name"
  "$bin/hovermodal" identify "$@" --report "$out/$name" >"$out/$name.txt" 2>"$out/$name.log" || { cat "$out/$name.log" >&2; return 1; }
  modes_of "$out/$name/modal.json" >"$out/$name.modes"
}

# modes_of MODAL_JSON: "frequency damping sigma_frequency sigma_damping" a line, structural modes only.
modes_of() {
  awk -F'[:,]' '
    /^  "modes": \[/ { on = 1 }
    /^  "rejected": \[/ { on = 0 }
    on && /^      "frequency_hz"/ { f = $2 }
    on && /^      "frequency_std_hz"/ { sf = $2 }
    on && /^      "damping_ratio"/ { z = $2 }
    on && /^      "damping_std"/ { print f + 0, z + 0, sf, $2 }' "$1"
}

# errors "REFERENCES" MODES: error in % of the mode nearest to each reference, one a line.
errors() {
  awk -v references="$1" '
    { f[NR] = $1 }
    END {
      n = split(references, r, " ")
      for (i = 1; i <= n; i++) {
        best = 1e9
        for (k = 1; k <= NR; k++) { e = 100 * (f[k] / r[i] - 1); if ((e < 0 ? -e : e) < (best < 0 ? -best : best)) best = e }
        printf "%.3f\n", best
      }
    }' "$2"
}

below() { awk -v limit="$1" '$1 < limit' "$2" | wc -l; }           # how many modes below LIMIT
# "nan" if there is none: a missing mode must not count as exact.
largest() { awk '{ e = $1 < 0 ? -$1 : $1; if (e > w) w = e } END { if (NR) print w + 0; else print "nan" }'; }
medium() { awk '{ print $1 < 0 ? -$1 : $1 }' | median_and_worst | cut -d' ' -f1; }
one_line() { tr '\n' ' '; }

have() {  # FOLDER NUMBER...: SKIP lines for the figures of absent data
  local folder=$1
  shift
  [ -d "$data/$folder" ] && return 0
  for number in "$@"; do line "$number" SKIP "-" "-" "no $data/$folder"; done
  return 1
}

# --- 2: five-storey frame, lasers beside accelerometers ---------------------------------------------------------------
figure_2() {
  local e n frame said setup
  local published="1.229 1.436 2.100 4.017 4.769 6.683 7.614 9.664"
  if have five_storey_frame 2a.01 2a.04 2a.07 2a.10 2b; then
    frame="$data/five_storey_frame"
    said=(--rate 256 --channels 1 2 3 4 5 --max-frequency 12)
    for setup in 01 04 07 10; do
      identify "setup_$setup" --series "$frame/setup_$setup.csv" "${said[@]}"
      e=$(errors "$published" "$out/setup_$setup.modes")
      n=$(below 10 "$out/setup_$setup.modes")
      judge "2a.$setup" "errors $(echo "$e" | one_line)%, $n modes below 10 Hz" "two lowest 0.25 %, others 0.10 %, 8 below 10 Hz" \
        "set-up $setup alone" "$(echo "$e" | head -n 2 | largest) <= 0.25 && $(echo "$e" | tail -n 6 | largest) <= 0.10 && $n == 8"
    done
    identify merged --series "$frame"/setup_{01,04,07,10}.csv "${said[@]}" --reference ref_x_m_s2 ref_y_m_s2 --merge
    e=$(errors "$published" "$out/merged.modes")
    n=$(below 10 "$out/merged.modes")
    judge 2b "errors $(echo "$e" | one_line)%, median $(echo "$e" | medium) %, $n modes below 10 Hz" \
      "each 0.10 %, median 0.03 %, 8 below 10 Hz" "four set-ups merged" \
      "$(echo "$e" | largest) <= 0.10 && $(echo "$e" | medium) <= 0.03 && $n == 8"
  fi
}

# --- 3: records computed by others ------------------------------------------------------------------------------------
figure_3() {
  local e z n sigmas own
  if have five_dof_example 3a; then
    identify five_dof --series "$data/five_dof_example/accelerations.csv" --rate 100 --max-frequency 10
    e=$(errors "0.890 2.598 4.095 5.261 6.000" "$out/five_dof.modes")
    z=$(awk '{ printf "%.1f\n", 100 * ($2 / 0.02 - 1) }' "$out/five_dof.modes")
    n=$(wc -l <"$out/five_dof.modes")
    judge 3a "frequency $(echo "$e" | one_line)%, damping $(echo "$z" | one_line)%, $n modes" \
      "frequency 0.25 %, damping 30 / 20 / 15 %, 5 modes" "five degrees of freedom against the truth" \
      "$(echo "$e" | largest) <= 0.25 && $n == 5 && $(echo "$z" | sed -n 1p | largest) <= 30 && $(echo "$z" | sed -n 2p | largest) <= 20 && $(echo "$z" | sed -n '3,5p' | largest) <= 15"
    # Errors in units of the stated standard deviations.
    sigmas=$(awk 'BEGIN { split("0.890 2.598 4.095 5.261 6.000", f) }
      function off(value, truth, sigma) { return sigma > 0 ? (value > truth ? value - truth : truth - value) / sigma : -1 }
      { a = off($1, f[NR], $3 + 0); b = off($2, 0.02, $4 + 0); if (a < 0 || b < 0) none = 1; if (a > w) w = a; if (b > w) w = b }
      END { print none ? "none" : w }' "$out/five_dof.modes")
    judge 3a.sigma "$sigmas" "2.5" "largest error of frequency and damping in stated standard deviations" "$sigmas <= 2.5"
  fi
  if have published_shear_frame 3b; then
    identify shear --series "$data/published_shear_frame/accelerations.csv" --quantity a --max-frequency 2
    own=$(awk 'BEGIN { n = split("1.1364 3.2968 5.1494 6.5562 7.4406", w); for (i = 1; i <= n; i++) printf "%.6f ", w[i] / (2 * 3.14159265358979) }')
    e=$(errors "$own" "$out/shear.modes")
    n=$(wc -l <"$out/shear.modes")
    judge 3b "errors $(echo "$e" | one_line)%, $n modes" "mode 1 0.35 %, others 0.15 %, nothing extra" \
      "shear frame against its package's own result" \
      "$(echo "$e" | head -n 1 | largest) <= 0.35 && $(echo "$e" | tail -n 4 | largest) <= 0.15 && $n == 5"
  fi
}

# --- 4: measured input, and a camera beside an accelerometer ------------------------------------------------------------
figure_4() {
  local e n near response beam
  if have mini_shake_table 4a; then
    identify shake --series "$data/mini_shake_table/flexible_northridge.csv" --input ground_m_s2 --max-frequency 24
    response=$(awk '/^response to the input/ { on = 1; next } /^note:/ { on = 0 } on { printf "%s ", $1 }' "$out/shake.txt")
    e=$(errors "$response" "$out/shake.modes")
    n=$(wc -l <"$out/shake.modes")
    near=$(errors "3.69 11.13 16.58" <(tr ' ' '\n' <<<"$response" | grep .) | largest)
    judge 4a "response $response Hz, errors $(echo "$e" | one_line)%, $n structural, $(grep -c input_peak "$out/shake.txt") input peaks" \
      "3 peaks at 3.69 11.13 16.58 Hz, each within 1 % of the response, no other structural" "shake table, Northridge, ground measured" \
      "$(wc -w <<<"$response") == 3 && $near <= 1 && $(echo "$e" | largest) <= 1 && $n == 3"
  fi
  if have ladisk_beam 4b; then
    beam="$data/ladisk_beam"
    identify beam_camera --series "$beam/camera_displacements_um.csv" --max-frequency 2500
    identify beam_accelerometer --series "$beam/accelerometer_and_force.lvm" --channels "Acceleration (Trigger)" --max-frequency 2500
    e=$(errors "695.6 1897.9" "$out/beam_camera.modes")
    judge 4b "errors $(echo "$e" | one_line)%; the accelerometer read by us $(errors "695.6 1897.9" "$out/beam_accelerometer.modes" | one_line)%" \
      "0.3 %" "beam filmed against its accelerometer, 695.6 and 1897.9 Hz" "$(echo "$e" | largest) <= 0.3"
  fi
}

run_figures "${figures[@]}"

#!/usr/bin/env bash
# The point tracker, figure by figure; one line each, MISS where a bar is not met. About 15 minutes; --quick: 5.
#   tools/figures/tracking.sh [--quick] [--first-seed N] [FIGURE...]      FIGURE: some of 1 ... 8 (default: all)
# Figures 1 and 7 measure time: leave the machine alone meanwhile. 4 needs measured data (HOVERMODAL_DATA), which know no seed.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/tracking.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
all_or_named 1 2 3 4 5 6 7 8
rounds=400 images=24 textures=8 drift_images=10000 bit_frames=1000 light_s=120 service_frames=5000 zoom_s=30
[ -z "$quick" ] || rounds=60 images=8 textures=2 drift_images=1000 bit_frames=100 light_s=40 service_frames=1000 zoom_s=10
out=$PWD/build/figures/tracking
cell() { awk -F'\t' -v name="$2" -v column="${3:-2}" '$1 == name { print $column }' "$1"; } # FILE ROW [COLUMN]
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh tracking_accuracy tracking_bias tracking_speed hovermodald

# --- 1: time -------------------------------------------------------------------------------------------------------------
figure_1() {
  "$bin/tracking_speed" $rounds "$first_seed" >"$out/speed.txt"
  local what ours theirs ratio bar least former few many
  while IFS=$'\t' read -r what ours theirs ratio _; do
    former="" # the bar of the tracker before this one, where it had one
    case $what in
    "frame 1080p") bar="1080p <= 1/15 of OpenCV with tight sub-images" least=15 former=8 ;;
    "frame 1080p, whole image's pyramid") bar="and 1/22 whole" least=22 ;;
    "frame 4K") bar="4K 1/12" least=12 former=15 ;;
    "frame 4K, whole image's pyramid") bar="and 1/60" least=60 ;;
    "frame 720p") bar="720p 1/12" least=12 ;;
    "frame 1080p, 0.7 px off") bar="from 0.7 px off 1/9" least=9 ;;
    point) bar=">= 4" least=4 ;;
    kernel) bar=">= 1.7" least=1.7 ;;
    *whole*) line 1 beside "$ours us against $theirs us, ratio $ratio" "-" "$what, as most programs do" && continue ;;
    fall-back) line 1 beside "$ours us" "-" "a frame in which all six regions jumped by 60 px" && continue ;;
    *) echo "# $what: $ours" && continue ;;
    esac
    judge 1 "$ours us against $theirs us, ratio $ratio" "$bar" "$what beside OpenCV, median of $rounds, 180 points, one thread" "$ratio >= $least"
    [ -z "$former" ] || judge 1 "$ours us against $theirs us, ratio $ratio" ">= $former" "$what, as asked of the former tracker" "$ratio >= $former"
  done <"$out/speed.txt"
  if command -v valgrind >/dev/null && grep -qw avx2 /proc/cpuinfo; then
    few=$(instructions 1) many=$(instructions 2)
    judge 1 "$(((many - few) / 180)) instructions" "Instructions a point <= 2 500 (AVX2)" "of a point, beside its neighbours in a frame of 180" \
      "$many - $few > 0 && ($many - $few) / 180 <= 2500"
    judge 1 "$(((many - few) / 180)) instructions" "<= 30000" "the same, as asked of the former tracker" "$many - $few > 0 && ($many - $few) / 180 <= 30000"
  else
    line 1 SKIP "no valgrind, or no AVX2" "Instructions a point <= 2 500 (AVX2)" "instructions of a point"
  fi
  tools/setup.sh --runtime
  build_bits arm64 aarch64-linux-gnu-g++ -static
  cc -O2 -shared -fPIC tools/figures/count_instructions.c -o "$out/count_instructions.so"
  few=$(instructions_on_arm64 1) many=$(instructions_on_arm64 2)
  judge 1 "$(((many - few) / 90)) instructions" "6 000 (arm64, counted by the emulator)" "of a point, beside its neighbours in a frame of 90" \
    "$many - $few > 0 && ($many - $few) / 90 <= 6000"
}
instructions() { # FRAMES: of that many frames
  valgrind --tool=callgrind --callgrind-out-file=/dev/null "$bin/tracking_speed" 0 "$first_seed" "$1" 2>&1 | awk '/Collected/ { print $4 }'
}
instructions_on_arm64() { # FINDS: so many times in one frame
  qemu-aarch64 -plugin "$out/count_instructions.so" -d plugin "$out/bits_arm64" 1 "$first_seed" "$1" 2>&1 | awk '/^instructions/ { print $2 }'
}

# --- 2, 3: accuracy ------------------------------------------------------------------------------------------------------
figure_2() {
  "$bin/tracking_accuracy" bound $images "$first_seed" >"$out/bound.txt"
  local most ratio noise contrast steep theirs
  echo "# cycles/px, noise, contrast, gradient/noise: ours and OpenCV's error over the bound, stated over scatter, lost"
  awk -F'\t' '{ printf "#   %s\t%s\t%s\t%s\t%s\t%s\t%s\t%s of %s\n", $2, $3, $4, $5, $6, $7, $8, $9, $10 }' "$out/bound.txt"
  read -r ratio theirs < <(awk -F'\t' '$2 <= 0.3 && $3 >= 1 && $5 >= 2 { if ($6 > m) m = $6; if ($7 > t) t = $7 } END { print m, t }' "$out/bound.txt")
  judge 2 "worst $ratio (OpenCV $theirs)" "<= 1.2" "error over the Cramer-Rao bound, texture to 0.3 cycles/px, gradient twice the noise" "$ratio <= 1.2"
  read -r ratio theirs < <(awk -F'\t' '$2 == 0.35 && $5 >= 2 { if ($6 > m) m = $6; if ($7 > t) t = $7 } END { print m, t }' "$out/bound.txt")
  judge 2 "worst $ratio (OpenCV $theirs)" "<= 1.3" "the same at 0.35 cycles/px" "$ratio <= 1.3"
  "$bin/tracking_accuracy" averaged $images "$first_seed" >"$out/averaged.txt"
  read -r ratio theirs < <(awk -F'\t' '{ if ($6 > m) m = $6; if ($7 > t) t = $7 } END { print m, t }' "$out/averaged.txt")
  judge 2 "worst $ratio (OpenCV $theirs)" "<= 1.25" "faint texture (gradient below twice the noise), templates averaged over 16 images" "$ratio <= 1.25"
  "$bin/tracking_bias" $textures "$first_seed" "$out/bias.svg" >"$out/bias.txt"
  echo "# curves in $out/bias.svg"
  bias() { # KIND LEAST MOST: the largest of ours and of OpenCV's
    awk -F'\t' -v kind="$1" -v least="$2" -v most="$3" '$1 == "bias" && $2 == kind && $3 + 0 >= least && $3 + 0 <= most {
      if ($4 > m) m = $4; if ($5 > t) t = $5 } END { print m, t }' "$out/bias.txt"
  }
  read -r ratio theirs < <(bias texture 0 0.25)
  judge 2 "$ratio px (OpenCV $theirs)" "<= 0.001" "largest bias over the fractions of a pixel, to 0.25 cycles/px" "$ratio <= 0.001"
  read -r ratio theirs < <(bias dots 0 9)
  judge 2 "$ratio px (OpenCV $theirs)" "<= 0.001" "the same on printed dots, radius 3 and 6 px, edges blurred by 0.3 to 1.2 px" "$ratio <= 0.001"
  read -r ratio theirs < <(bias aligned 0 9)
  line 2 beside "$ratio px (OpenCV $theirs)" "-" "dots that all lie at the same place among their pixels, where an edge of 0.3 px is an alias"
  read -r ratio theirs < <(bias texture 0.35 0.35)
  judge 2 "$ratio px (OpenCV $theirs)" "<= 0.002" "texture to 0.35 cycles/px" "$ratio <= 0.002"
}
figure_3() {
  "$bin/tracking_accuracy" bound $images "$first_seed" >"$out/bound.txt"
  local least most begin end deviation
  read -r least most < <(awk -F'\t' '$5 >= 2 { if (!n++ || $8 < l) l = $8; if ($8 > m) m = $8 } END { print l, m }' "$out/bound.txt")
  judge 3 "$least ... $most" "0.9 ... 1.1" "stated deviation over scatter, all textures with gradient twice the noise" "$least >= 0.9 && $most <= 1.1"
  "$bin/tracking_accuracy" drift $drift_images "$first_seed" >"$out/drift.txt"
  IFS=$'\t' read -r _ begin end _ _ deviation <"$out/drift.txt"
  judge 3 "$begin px, then $end px (+- $deviation)" "does not grow (three standard deviations of the difference)" \
    "error in the first and the last tenth of $drift_images frames" "$end - $begin <= 3 * $deviation"
}

# --- 4: measured dots ----------------------------------------------------------------------------------------------------
figure_4() {
  local knex=$data/knex_frame_video share lost what="28 dots of a released frame, a region each, against the given centroids"
  if [ ! -f "$knex/knex_1300x2046_gray.mp4" ]; then
    line 4 SKIP "no data at $knex" ">= 95 % within 0.5 px, none lost" "$what"
    return
  fi
  tools/figures/tracking_knex.py config "$knex" >"$out/knex.yaml"
  rm -rf "$out/knex"
  quietly "$bin/hovermodald" --config "$out/knex.yaml" --report "$out/knex"
  read -r share lost < <(tools/figures/tracking_knex.py compare "$knex" "$out/knex/tracks.csv" | tee "$out/knex.txt" | tail -n 1)
  judge 4 "$share % within 0.5 px, $lost dots lost for good" ">= 95 %, 0" "$what" "$share >= 95 && $lost == 0"
  judge_forks
}
judge_forks() {
  local forks=$data/tuning_forks name frames points ours theirs lost_by_us lost_by_them
  if [ ! -d "$forks" ]; then
    line 4 SKIP "no data at $forks" "lower than OpenCV's" "noise floor in clips of tuning forks"
    return
  fi
  quietly tools/build.sh tracking_noise_floor
  "$bin/tracking_noise_floor" "$forks"/*.mp4 >"$out/forks.txt"
  while IFS=$'\t' read -r name frames points ours theirs lost_by_us lost_by_them; do
    judge 4 "$ours against $theirs, $lost_by_us and $lost_by_them lost" "lower than OpenCV's" \
      "noise floor (root of the median density, px at a rate of 1 Hz) of $points points in $name, $frames frames" "$ours < $theirs"
  done <"$out/forks.txt"
}

# --- 5: light that changes ------------------------------------------------------------------------------------------------
figure_5() {
  quietly tools/build.sh tracking_light
  "$bin/tracking_light" "$light_s" "$first_seed" >"$out/light.txt"
  value() { cell "$out/light.txt" "$@"; }
  against() { # LIGHT OTHER: of points and of regions, "+5.4 % (regions +9.0 %)"
    awk -v a="$(value "$1" 2)" -v b="$(value "$2" 2)" -v c="$(value "$1" 4)" -v d="$(value "$2" 4)" \
      'BEGIN { printf "%+.1f %% (regions %+.1f %%)", 100 * (a / b - 1), 100 * (c / d - 1) }'
  }
  local light what
  for light in flicker shadow; do
    what=$([ $light = flicker ] && echo "lamps that flicker by 10 % at 7 Hz" || echo "the edge of a shadow of 40 % over the picture and back")
    judge 5 "$(against $light steady), $(value $light 2) px; OpenCV $(value steady 3) -> $(value $light 3) px" "+10 %" \
      "rms error of points under $what, $light_s s, $(awk -v s="$(value $light 5)" 'BEGIN { print 100 * s }') % of the points seen" \
      "$(value $light 2) <= 1.1 * $(value steady 2)"
    judge 5 "$(value $light 7) false, $(value $light 6) true, worst $(value $light 8) %" "0 false, $(value steady 6) true" \
      "structural modes under $what" "$(value $light 7) == 0 && $(value $light 6) >= $(value steady 6)"
  done
  line 5 beside "$(against shadow dimmed)" "-" "the shadow against as much light without an edge"
}

# --- 6: the same bits everywhere -----------------------------------------------------------------------------------------
build_bits() { # NAME COMPILER FLAG...: tracking_bits without the rest of the project
  local name=$1 compiler=$2
  shift 2
  "$compiler" -std=c++20 -O3 -ffp-contract=off -I. "$@" tests/bench/tracking_bits.cpp \
    core/tracking/{point_finder,point_reseeder,region_deformation,region_search,region_follower,motion_predictor,outlier_rejection}.cpp core/tracking/klt/*.cpp \
    -o "$out/bits_$name"
}
figure_6() {
  tools/setup.sh --runtime
  local machines=(sse2 clones) name seen
  build_bits sse2 g++ -DHOVERMODAL_NO_VECTOR_CLONES
  build_bits clones g++
  if grep -qw avx2 /proc/cpuinfo; then  # without FMA, which GCC 12 uses for complex products whatever -ffp-contract says
    build_bits avx2 g++ -DHOVERMODAL_NO_VECTOR_CLONES -mavx2 && machines+=(avx2)
  fi
  for name in "${machines[@]}"; do "$out/bits_$name" "$bit_frames" "$first_seed" >"$out/bits_$name.txt"; done
  build_bits arm64 aarch64-linux-gnu-g++ -static
  qemu-aarch64 "$out/bits_arm64" "$bit_frames" "$first_seed" >"$out/bits_arm64.txt"
  seen=$(awk -F'\t' '{ n += $2; of += substr($2, index($2, "of ") + 3) } END { printf "%d of %d", n, of }' "$out/bits_sse2.txt")
  for name in "${machines[@]:1}" arm64; do
    judge 6 "$(tail -n 1 "$out/bits_$name.txt" | cut -f 3), $seen points seen" "that of SSE2: $(tail -n 1 "$out/bits_sse2.txt" | cut -f 3)" \
      "hash of all tracks of $bit_frames frames, $name" "$(cmp -s "$out/bits_sse2.txt" "$out/bits_$name.txt" && echo 1 || echo 0) == 1"
  done
}

# --- 7: the whole service ------------------------------------------------------------------------------------------------
figure_7() {
  quietly tools/build.sh service_speed hooks_tests
  "$bin/service_speed" "$service_frames" "$first_seed" >"$out/service.txt"
  value() { cell "$out/service.txt" "$@"; }
  local stage shares="" n_calls
  for stage in capture tracking spectrum identification publish; do
    shares+="${shares:+, }$stage $(value $stage) us ($(awk -v s="$(value $stage 3)" 'BEGIN { printf "%.1f", 100 * s }') %)"
  done
  judge 7 "$(value rate) frames a second, $(value "rate with it") before" "more than before" \
    "the whole service at 1920 x 1080 on one processor, $(value points | cut -d ' ' -f 1) points, nothing decoded; before: with OpenCV's tracker ($(value opencv) us)" \
    "$(value rate) > $(value "rate with it")"
  line 7 beside "$shares" "-" "processor time of a frame by stage"
  HOVERMODAL_HOOK_FRAMES=1000 HOVERMODAL_HOOK_REPORT=$out/hooks.tsv build/release/tests/hooks_tests >"$out/hooks.txt" 2>&1 || true
  n_calls=$(awk -F'\t' '$1 == "site" && $2 == "hm-tracking" { n += $4 } END { print n + 0 }' "$out/hooks.tsv")
  judge 7 "$n_calls" 0 "allocations and locks of the tracking stage over 1000 frames" "$n_calls == 0 && $(grep -c PASSED "$out/hooks.txt" || true) == 1"
}

# --- 8: images that a moving camera deforms --------------------------------------------------------------------------------
figure_8() {
  quietly tools/build.sh tracking_deformation
  local noise what n error per_zoom per_roll left ratio share zoom
  for noise in 0.5 2; do
    while IFS=$'\t' read -r what n error per_zoom per_roll left ratio share zoom; do
      line 8 beside "$error px, $left px without the part that goes with it ($per_zoom px a unit)" "-" \
        "error of $n points on $what, noise $noise, magnification $(awk -v z="$zoom" 'BEGIN { printf "%.2f", 100 * z }') % rms, $share of them seen"
      judge 8 "$ratio" "0.9 ... 1.1" "stated deviation over scatter of these" "$ratio >= 0.9 && $ratio <= 1.1"
    done < <("$bin/tracking_deformation" "$zoom_s" "$first_seed" 540 25 "$noise")
  done
}

run_figures "${figures[@]}"

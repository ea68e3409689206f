#!/usr/bin/env bash
# The figures of simulator and report: is the truth true, and can the report be read? One line a figure.
#   tools/figures/truth_and_report.sh [--quick] [--first-seed N] [FIGURE...]      FIGURE: some of 1 2a 2b 3 4 5 6 (default: all)
# --quick takes the report of a 12 s clip for that of the demo, and leaves out 2b.
# Line 6 needs Debian's package chromium (or its browser at $CHROMIUM).
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/truth_and_report.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
all_or_named 1 2a 2b 3 4 5 6
seconds=60
[ -z "$quick" ] || seconds=12
out=build/figures/truth_and_report
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh hovermodald hovermodal hovermodal-validate

# --- 1: known shifts -------------------------------------------------------------------------------------------------
figure_1() {
  local n worst smooth
  "$bin/hovermodal-validate" shifts --first-seed "$first_seed" >"$out/shifts.txt"
  read -r n worst smooth < <(awk -F'\t' '$1 == "shift" { n++; w = $3 + 0 > w ? $3 + 0 : w; if ($2 ~ /^smooth/ && $4 + 0 > s) s = $4 + 0 }
    END { print n + 0, w + 0, s + 0 }' "$out/shifts.txt")
  judge 1 "$n scenes, worst $worst px, rms of smooth texture at most $smooth px" "16 scenes, 0.005 px worst, 0.001 px rms" \
    "plates drawn at known shifts: still and blurred, straight and turned, through a lens, read downwards and sideways" \
    "$n == 16 && $worst > 0 && $worst <= 0.005 && $smooth <= 0.001"
}

# --- 2: peaks of the truth -------------------------------------------------------------------------------------------
peaks() { # modes, largest |mean|, least and largest rms of a table of `hovermodal-validate peaks`
  awk -F'\t' '$1 == "peak" { n++; if ($6 !~ /[0-9]/ || $7 !~ /[0-9]/) none = 1; m = $6 < 0 ? -$6 : $6; if (m > w) w = m; if (l == "" || $7 < l) l = $7; if ($7 > h) h = $7 }
    END { if (none) print n / 2, "nan nan nan"; else printf "%d %.2f %.2f %.2f\n", n / 2, w, l, h }' "$1"
}
peaks_figure() { # NUMBER SEEDS MEAN LEAST MOST WHAT
  local modes mean low high
  "$bin/hovermodal-validate" peaks --first-seed "$first_seed" --seeds "$2" >"$out/peaks$2.txt"
  read -r modes mean low high < <(peaks "$out/peaks$2.txt")
  judge "$1" "$modes modes, mean error at most $mean, rms $low ... $high of the theoretical scatter" "mean <= $3, rms $4 ... $5" \
    "$6, $(seeds_of "$2")" "$modes == 6 && $mean <= $3 && $low >= $4 && $high <= $5"
}
figure_2a() { peaks_figure 2a 20 0.67 0.6 1.4 "frequency and damping of 600 s of truth, by a fit of the simulator's own"; }
figure_2b() {
  local what="the same of 300 seeds: chance, or the simulator?"
  if [ -n "$quick" ]; then line 2b SKIP "--quick" "mean <= 0.17, rms 0.87 ... 1.14" "$what"; else peaks_figure 2b 300 0.17 0.87 1.14 "$what"; fi
}

# --- 3: each effect against its first-order signature ----------------------------------------------------------------
figure_3() {
  local effects worst name
  "$bin/hovermodal-validate" signatures --first-seed "$first_seed" >"$out/signatures.txt"
  read -r effects worst name < <(awk -F'\t' '$1 == "signature" { n++; split($4, e, " "); if (e[1] >= w) { w = e[1]; name = $2 } }
    END { gsub(" ", "_", name); print n + 0, w, name }' "$out/signatures.txt")
  judge 3 "$effects effects, worst $worst % ($name)" "1 % of the effect's rms" \
    "tracks with each effect minus tracks without it, against its first-order signature" "$effects >= 20 && $worst <= 1"
}

# --- 4: speed --------------------------------------------------------------------------------------------------------
figure_4() {
  local started took rows rates
  started=$(date +%s.%N)
  quietly "$bin/hovermodal" simulate --tracks-only --points 9 --duration 300 --seed "$first_seed" --force --out "$out/tracks"
  took=$(awk -v a="$started" -v b="$(date +%s.%N)" 'BEGIN { printf "%.1f", b - a }')
  judge 4a "$took s" "10 s" "300 s of tracks, 72 points at 25 fps" "$took <= 10"
  started=$(date +%s.%N)
  quietly "$bin/hovermodal" simulate --channels-only --duration 3600 --seed "$first_seed" --force --out "$out/channels"
  took=$(awk -v a="$started" -v b="$(date +%s.%N)" 'BEGIN { printf "%.1f", b - a }')
  rows=$(grep -c '^[0-9]' "$out/channels/displacements.csv")
  judge 4b "$took s, $rows rows" "30 s, 90000 rows" "an hour of displacement samples of 7 channels at 25 fps" "$took <= 30 && $rows == 90000"
  "$bin/hovermodal-validate" speed --first-seed "$first_seed" >"$out/speed.txt"
  rates=$(awk -F'\t' '$1 == "speed" { printf "%s%s %s", s, $3, $2; s = ", " }' "$out/speed.txt")
  judge 4c "$rates" "printed" "1080p frames drawn per second on 2 threads" "$(awk -F'\t' '$1 == "speed" { n++ } END { print n + 0 }' "$out/speed.txt") == 3"
}

# --- 5: other people's tracker in our frames --------------------------------------------------------------------------
figure_5() {
  local n worst lost
  "$bin/hovermodal-validate" klt --first-seed "$first_seed" >"$out/klt.txt"
  read -r n worst lost < <(awk -F'\t' '$1 == "klt" { n += $6; l += $7; if ($4 + 0 > w) w = $4 + 0 } END { print n + 0, w + 0, l + 0 }' "$out/klt.txt")
  judge 5 "three scenes, $n points, $lost lost, rms at most $worst px" "0.05 px rms per axis" \
    "OpenCV's KLT in drawn frames with noise of 2 grey levels, against the true tracks" \
    "$n == 16800 && $lost == 0 && $worst > 0 && $worst <= 0.05"
}

# --- 6: the report in a browser --------------------------------------------------------------------------------------
figure_6() {
  local words
  if quietly tools/demo.sh --seconds "$seconds" --seed "$first_seed" --out "$out/demo"; then
    words=$(tools/figures/check_report.sh "$out/demo/report.html" --screenshots "$out/screenshots" 2>&1 | tail -n 1) || true
    case $words in
      ok*) line 6 ok "${words#ok }" "no console error, no request, < 2 MB" "report.html of the demo in headless Chromium" ;;
      *) line 6 MISS "$words" "no console error, no request, < 2 MB" "report.html of the demo in headless Chromium" ;;
    esac
  else
    line 6 MISS "the demo failed" "no console error, no request, < 2 MB" "report.html of the demo in headless Chromium"
  fi
}

run_figures "${figures[@]}"

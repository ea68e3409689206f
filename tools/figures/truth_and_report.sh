#!/usr/bin/env bash
# The figures of simulator and report: is the truth true, and can the report be read? One line a figure.
#   tools/figures/truth_and_report.sh [--quick]      --quick takes the report of a 12 s clip for that of the demo, and leaves out 2b
# Line 6 needs Debian's package chromium (or its browser at $CHROMIUM).
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
seconds=60
[ "${1:-}" != --quick ] || seconds=12
out=build/figures/truth_and_report
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh hovermodald hovermodal

# --- 1: known shifts -------------------------------------------------------------------------------------------------
"$bin/hovermodal" selftest shifts >"$out/shifts.txt"
read -r n worst smooth < <(awk -F'\t' '$1 == "shift" { n++; w = $3 + 0 > w ? $3 + 0 : w; if ($2 ~ /^smooth/ && $4 + 0 > s) s = $4 + 0 }
  END { print n + 0, w + 0, s + 0 }' "$out/shifts.txt")
judge 1 "$n scenes, worst $worst px, rms of smooth texture at most $smooth px" "16 scenes, 0.005 px worst, 0.001 px rms" \
  "plates drawn at known shifts: still and blurred, straight and turned, through a lens, read downwards and sideways" \
  "$n == 16 && $worst > 0 && $worst <= 0.005 && $smooth <= 0.001"

# --- 2: peaks of the truth -------------------------------------------------------------------------------------------
"$bin/hovermodal" selftest peaks >"$out/peaks.txt"
peaks() { # modes, largest |mean|, least and largest rms of a table of `selftest peaks`
  awk -F'\t' '$1 == "peak" { n++; m = $6 < 0 ? -$6 : $6; if (m > w) w = m; if (l == "" || $7 < l) l = $7; if ($7 > h) h = $7 }
    END { printf "%d %.2f %.2f %.2f\n", n / 2, w, l, h }' "$1"
}
read -r modes mean low high < <(peaks "$out/peaks.txt")
judge 2a "$modes modes, mean error at most $mean, rms $low ... $high of the theoretical scatter" "mean <= 0.67, rms 0.6 ... 1.4" \
  "frequency and damping of 600 s of truth, seeds 1-20, by a fit of the simulator's own" \
  "$modes == 6 && $mean <= 0.67 && $low >= 0.6 && $high <= 1.4"
if [ "$seconds" -eq 60 ]; then
  "$bin/hovermodal" selftest peaks --seeds 300 >"$out/peaks300.txt"
  read -r modes mean low high < <(peaks "$out/peaks300.txt")
  judge 2b "$modes modes, mean error at most $mean, rms $low ... $high of the theoretical scatter" "mean <= 0.17, rms 0.87 ... 1.14" \
    "the same of seeds 1-300: chance, or the simulator?" "$modes == 6 && $mean <= 0.17 && $low >= 0.87 && $high <= 1.14"
fi

# --- 3: each effect against its first-order signature ----------------------------------------------------------------
"$bin/hovermodal" selftest signatures >"$out/signatures.txt"
read -r effects worst name < <(awk -F'\t' '$1 == "signature" { n++; split($4, e, " "); if (e[1] >= w) { w = e[1]; name = $2 } }
  END { gsub(" ", "_", name); print n + 0, w, name }' "$out/signatures.txt")
judge 3 "$effects effects, worst $worst % ($name)" "1 % of the effect's rms" \
  "tracks with each effect minus tracks without it, against its first-order signature" "$effects >= 20 && $worst <= 1"

# --- 4: speed --------------------------------------------------------------------------------------------------------
started=$(date +%s.%N)
quietly "$bin/hovermodal" simulate --tracks-only --points 9 --duration 300 --force --out "$out/tracks"
took=$(awk -v a="$started" -v b="$(date +%s.%N)" 'BEGIN { printf "%.1f", b - a }')
judge 4a "$took s" "10 s" "300 s of tracks, 72 points at 25 fps" "$took <= 10"
started=$(date +%s.%N)
quietly "$bin/hovermodal" simulate --channels-only --duration 3600 --force --out "$out/channels"
took=$(awk -v a="$started" -v b="$(date +%s.%N)" 'BEGIN { printf "%.1f", b - a }')
rows=$(grep -c '^[0-9]' "$out/channels/displacements.csv")
judge 4b "$took s, $rows rows" "30 s, 90000 rows" "an hour of displacement samples of 7 channels at 25 fps" "$took <= 30 && $rows == 90000"
"$bin/hovermodal" selftest speed >"$out/speed.txt"
rates=$(awk -F'\t' '$1 == "speed" { printf "%s%s %s", s, $3, $2; s = ", " }' "$out/speed.txt")
judge 4c "$rates" "printed" "1080p frames drawn per second on 2 threads" "$(awk -F'\t' '$1 == "speed" { n++ } END { print n + 0 }' "$out/speed.txt") == 3"

# --- 5: other people's tracker in our frames --------------------------------------------------------------------------
"$bin/hovermodal" selftest klt >"$out/klt.txt"
read -r n worst lost < <(awk -F'\t' '$1 == "klt" { n += $6; l += $7; if ($4 + 0 > w) w = $4 + 0 } END { print n + 0, w + 0, l + 0 }' "$out/klt.txt")
judge 5 "three scenes, $n points, $lost lost, rms at most $worst px" "0.05 px rms per axis" \
  "OpenCV's KLT in drawn frames with noise of 2 grey levels, against the true tracks" \
  "$n == 16800 && $lost == 0 && $worst > 0 && $worst <= 0.05"

# --- 6: the report in a browser --------------------------------------------------------------------------------------
if quietly tools/demo.sh --seconds "$seconds" --seed 1 --out "$out/demo"; then
  words=$(tools/figures/check_report.sh "$out/demo/report.html" --screenshots "$out/screenshots" 2>&1 | tail -n 1) || true
  case $words in
    ok*) line 6 ok "${words#ok }" "no console error, no request, < 2 MB" "report.html of the demo in headless Chromium" ;;
    *) line 6 MISS "$words" "no console error, no request, < 2 MB" "report.html of the demo in headless Chromium" ;;
  esac
else
  line 6 MISS "the demo failed" "no console error, no request, < 2 MB" "report.html of the demo in headless Chromium"
fi

[ "$misses" -eq 0 ]

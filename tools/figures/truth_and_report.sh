#!/usr/bin/env bash
# The figures of simulator and report: is the truth true, and can the report be read? One line a figure.
#   tools/figures/truth_and_report.sh [--quick]      --quick takes the report of a 12 s clip for that of the demo
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

line 1 MISS "not measured" "0.005 px worst, 0.001 px rms" "known shifts of smooth and sharp texture: no command yet"
"$bin/hovermodal" selftest peaks >"$out/peaks.txt"
read -r modes mean low high < <(awk -F"\t" '$1 == "peak" { n++; m = $6 < 0 ? -$6 : $6; if (m > w) w = m; if (l == "" || $7 < l) l = $7; if ($7 > h) h = $7 }
  END { print n / 2, w, l, h }' "$out/peaks.txt")
judge 2 "$modes modes, mean error at most $mean, rms $low ... $high of the theoretical scatter" "mean <= 0.67, rms 0.6 ... 1.4" \
  "frequency and damping of 600 s of truth, 20 seeds, by a fit of the simulator's own" \
  "$modes == 6 && $mean <= 0.67 && $low >= 0.6 && $high <= 1.4"

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
line 4b MISS "not measured" "30 s" "an hour of channels: no command yet"

line 5 MISS "not measured" "0.05 px rms" "rendered frames by OpenCV's tracker against truth: no command yet"

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

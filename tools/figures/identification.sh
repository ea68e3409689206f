#!/usr/bin/env bash
# The figures of the identification: spectra, measured records, simulated records of known truth, cost. One line a figure.
#   tools/figures/identification.sh [--quick]      --quick takes a tenth of the seeds, and little of the clock
# Lines 1, 9, 10 come from identification_speed.sh, 2-4 from identification_measured.sh, 5-8 from `hovermodal selftest`,
# whose tables stay in build/figures/identification.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
many=200 seeds=100 few=20 quick=
[ "${1:-}" != --quick ] || { many=20 seeds=10 few=4 quick=--quick; }
out=build/figures/identification
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh hovermodal

part() { # SCRIPT ...: its lines; its misses are ours
  local text
  text=$("$@" 2>&1) || true
  grep -E '^[0-9]' <<<"$text" || echo "$text"
  misses=$((misses + $(grep -cE '^[0-9a-z.]+ MISS ' <<<"$text" || true)))
}
check() { # NAME SEEDS: the table of a self-test
  "$bin/hovermodal" selftest "$1" --seeds "$2" >"$out/$1.txt"
}
table() { # NAME FILTER PROGRAM: awk over the rows of a table that the filter takes
  awk -F'\t' "function size(x) { return x < 0 ? -x : x } $2 { n++; $3 } END { $4 }" "$out/$1.txt"
}

part tools/figures/identification_speed.sh $quick
part tools/figures/identification_measured.sh

# --- 5: bias, scatter, intervals --------------------------------------------------------------------------------------
check bias $many
read -r n f z < <(table bias '$1 == "bias" && $2 == "corrected" && $5 == "clear"' \
  'a = size($7) - 2 * $8; b = size($9) - 2 * $10; if (n == 1 || a > f) f = a; if (n == 1 || b > z) z = b' 'print n + 0, f + 0, z + 0')
judge 5a "$n modes, beyond two standard errors f at most $f %, damping at most $z %" "0.02 %, 3 %" \
  "mean error over $many records of 300 s, 60 Hz, six storeys, damping 1 %" "$n == 6 && $f <= 0.02 && $z <= 3"
read -r n f z < <(table bias '$1 == "bias" && $2 == "corrected" && $5 == "clear"' \
  'if ($12 > f) f = $12; if ($13 > z) z = $13' 'print n + 0, f + 0, z + 0')
judge 5b "f at most $f, damping at most $z" "1.25" "their scatter over the least possible" "$n == 6 && $f <= 1.25 && $z <= 1.25"
read -r n low high < <(table bias '$1 == "bias" && $2 == "corrected"' \
  'for (i = 14; i <= 15; i++) { if (low == "" || $i < low) low = $i; if ($i > high) high = $i }' 'print n + 0, low, high')
read -r f z < <(table bias '$1 == "bias-all" && $2 == "corrected"' 'f = $5; z = $6' 'print f, z')
judge 5c "pooled $f and $z %, each mode $low ... $high %" "pooled 93-97 %, each 90-98 %" \
  "truth within the stated 95 % intervals, f and damping" \
  "$n == 6 && $f >= 93 && $f <= 97 && $z >= 93 && $z <= 97 && $low >= 90 && $high <= 98"
line 5d beside "$(table bias '$1 == "bias" && $2 == "uncorrected"' 's = s sprintf("%s%g Hz: found %d, damping %+.0f %%", n > 1 ? "; " : "", $3, $6, $9)' 'print s')" \
  "none" "the same without dividing the window out"

# --- 6: losses ----------------------------------------------------------------------------------------------------------
check losses $few
read -r n lost worst < <(table losses '$1 == "losses" && $2 == "bridged" && $4 > 0' 'lost += $7 - $6; if ($9 > w) w = $9' 'print n + 0, lost + 0, w + 0')
judge 6 "worst $worst %, $lost modes lost" "0.3 %, none lost" \
  "modes 1-3 against the estimate without losses: 1, 5, 30 % of samples, or of whole frames, lost; $few seeds" \
  "$n == 18 && $worst <= 0.3 && $lost == 0"

# --- 7: above half the frame rate ---------------------------------------------------------------------------------------
check folding $seeds
parts='$1 == "folding" && $2 ~ /^parts/'
read -r n least worst mac right wrong < <(table folding "$parts" \
  's = $6 > 0 ? 100 / $6 : 0; if (least == "" || s * $7 < least) least = s * $7; wrong += $9
   if ($4 == 600) { r = s * $8; if (right == "" || r < right) right = r; if ($5 > 12) { e = size($12); if (e > w) w = e; if (mac == "" || s * $14 < mac) mac = s * $14 } }' \
  'print n + 0, least + 0, w + 0, mac + 0, right + 0, wrong + 0')
judge 7a "found at least $least %; 600 s: modes 5 and 6 worst $worst %, MAC >= 0.98 in at least $mac %, certain and right in $right %; certain and wrong $wrong" \
  "all found, 0.25 %, 98 %, 98 %, never" "25 fps, readout 0.66 and 0.9 of a frame, 300 and 600 s, noise 0.003 and 0.1 px, $seeds seeds" \
  "$n == 48 && $least == 100 && $worst <= 0.25 && $mac >= 98 && $right >= 98 && $wrong == 0"
read -r n right wrong six < <(table folding '$1 == "folding" && $2 == "base"' \
  's = $6 > 0 ? 100 / $6 : 0; wrong += $9; if ($5 < 14) { if (right == "" || s * $8 < right) right = s * $8 } else if (six == "" || s * $8 < six) six = s * $8' \
  'print n + 0, right + 0, wrong + 0, six + 0')
judge 7b "modes 1-5 right in at least $right %, mode 6 in at least $six %, certain and wrong $wrong" "100 %, -, never" \
  "the same with white base acceleration (mode 6 then moves the roof by 0.0007 px)" "$n == 24 && $right == 100 && $wrong == 0"
read -r n certain < <(table folding '$1 == "folding" && ($2 == "span-0.1" || $2 == "two-channels") && $5 > 2' 'c += $8 + $9' 'print n + 0, c + 0')
judge 7c "called certain $certain times" "never" "rows over a tenth of the image, or two channels: modes 2-6 (mode 1 has no rival below 20 Hz)" \
  "$n == 20 && $certain == 0"
read -r n worst < <(table folding '$1 == "folding-readout" && $5 == "stated"' 'e = size($10); if (e > w) w = e' 'print n + 0, w + 0')
judge 7d "worst $worst" "0.03" "readout time read off the shapes, frames" "$n == 8 && $worst <= 0.03"

# --- 8: what is no mode -------------------------------------------------------------------------------------------------
check null $seeds
read -r n records < <(table null '$1 == "null"' 'if ($4 > r) r = $4' 'print n + 0, r + 0')
judge 8a "$records of $seeds records with a structural pole" "1" "a rigid building, hover, rotor line; with and without a base" "$n == 2 && $records <= 1"
check harmonics $seeds
read -r n share < <(table harmonics '$1 == "rotor"' 's = 100 * ($6 + $8) / $3; if (w == "" || s < w) w = s' 'print n + 0, w + 0')
judge 8b "at least $share %" "95 %" "a wandering rotor line called camera motion or harmonic" "$n == 2 && $share >= 95"
for strength in 1.0 0.3; do
  read -r n share falsely < <(table harmonics "\$1 == \"steady\" && \$2 == 1.0 && \$3 == $strength" 'h = 100 * $9 / $4; f = 100 * $14 / $4' 'print n + 0, h + 0, f + 0')
  judge 8c "harmonic in $share %; true modes so called $falsely in 100 records" "80 %, 2" \
    "a steady force of 600 s, its line $strength times as large as the mode beside" "$n == 1 && $share >= 80 && $falsely <= 2"
done
read -r n rms worst < <(table harmonics '$1 == "steady" && $2 == 1.0 && $3 == 1.0' 'r = $20; w = $21' 'print n + 0, r + 0, w + 0')
judge 8d "rms $rms, worst $worst %" "0.2 %" "the mode beside it against the same record without the line" "$n == 1 && $worst <= 0.2"

[ "$misses" -eq 0 ]

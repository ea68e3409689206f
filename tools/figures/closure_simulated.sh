# Figures 1 to 3 of closing the loop: made-up records with an undeclared effect, with none, with one that nobody thought
# of. Sourced by closure.sh.

# --- 1: undeclared effects -----------------------------------------------------------------------------------------------
figure_1() {
  figure_1_tracks
  figure_1_pairs
  figure_1_series
  figure_1_structures
}
figure_1_tracks() {
  selftest closure-tracks "$known"
  grep '^# bars' "$out/closure-tracks.txt"
  echo "# confusion: effect, strength, what was named, records"
  awk -F'\t' '$1 == "closure-tracks" { n[$2 "\t" $3 "\t" $8]++ } END { for (k in n) print "#\t" k "\t" n[k] }' "$out/closure-tracks.txt" | sort
  local effect strength n exact within after bias before modal twin share most right bar what
  while IFS=$'\t' read -r effect strength n exact within after bias before modal twin; do
    share=0.95 most=1.1 right="$within >= $exact" bar="all within 3 sigma"
    [ "$effect" != "readout time" ] || right="$bias <= 0.03 && $bias >= -0.03" bar="bias 0.03"
    [ "$effect" != "rotor line" ] || share=0.9
    [ "$effect" != "camera yaw" ] || most=1.25
    what="modal error $before -> $modal %, without the effect $twin % (median rms)"
    if [ "$strength" = 0.2 ]; then
      line "1.${effect// /_}.$strength" beside "alone and right $exact of $n, within 3 sigma $within, after $after of the floor" "-" "$what"
    else
      judge "1.${effect// /_}.$strength" "alone and right $exact of $n, within 3 sigma $within, after $after of the floor, bias $bias" \
        "$share of records, $bar, $most" "$what" \
        "$exact >= $share * $n && $after <= $most && $right"
    fi
  done < <(tracks_cells)
}
tracks_cells() { # a line per effect and strength, from the records' lines
  python3 - "$out/closure-tracks.txt" <<'PY'
import collections, statistics, sys
cells = collections.OrderedDict()
for row in open(sys.argv[1]):
    f = row.rstrip("\n").split("\t")
    if f[0] == "closure-tracks":
        cells.setdefault((f[1], f[2]), []).append(f)
def middle(rows, i):
    values = [float(r[i]) for r in rows if r[i] not in ("nan", "-nan")]
    return statistics.median(values) if values else float("nan")
for (effect, strength), rows in cells.items():
    exact = [r for r in rows if r[7] == effect]
    within = [r for r in exact if abs(float(r[11])) <= 3.0]
    after = max(float(r[9]) / float(r[10]) for r in rows)
    bias = statistics.mean(float(r[12]) for r in exact) if exact else float("nan")
    print(effect, strength, len(rows), len(exact), len(within), f"{after:.3f}", f"{bias:.4g}",
          *(f"{middle(rows, i):.3f}" for i in (13, 14, 15)), sep="\t")
PY
}
figure_1_pairs() {
  selftest closure-tracks-pairs "$known"
  local pair n both
  while IFS=$'\t' read -r pair n both; do
    judge "1p.${pair// /_}" "both and nothing else in $both of $n" "0.85 of records" "two effects of strength 1" "$both >= 0.85 * $n"
  done < <(awk -F'\t' '$1 == "closure-tracks-pair" { n[$2]++; split($2, a, " \\+ "); if ($5 == a[1] " + " a[2] || $5 == a[2] " + " a[1]) both[$2]++ }
    END { for (p in n) print p "\t" n[p] "\t" both[p] + 0 }' "$out/closure-tracks-pairs.txt" | sort)
}
figure_1_series() {
  selftest closure-series "$known"
  local effect strength n alone with wrong nothing value before after right bar
  while IFS=$'\t' read -r _ effect strength n alone with wrong nothing value _ before after; do
    right=$alone bar="alone in 90 %"
    [[ $effect != frequency_drift && $effect != softening ]] || right="$alone + $with" bar="found in 90 %"
    judge "1.$effect.${strength// /_}" "$alone of $n named alone ($with with another, $wrong another, $nothing nothing); mean number $value; held-out innovations $before -> $after" \
      "$bar" "$effect of $strength in 120 s of channels" "$right >= 0.9 * $n"
  done < <(grep '^series' "$out/closure-series.txt")
}
figure_1_structures() {
  selftest closure "$known"
  local effect n rms alone first_of among wrong nothing
  while IFS=$'\t' read -r _ effect n rms alone first_of among wrong nothing; do
    judge "1s.$effect" "named $((alone + first_of)) (alone $alone), among the rivals $among, wrong $wrong, nothing $nothing of $n" \
      "true effect named or among those not told apart in 95 %" "residual $rms % rms without it" "$alone + $first_of + $among >= 0.95 * $n"
  done < <(grep '^closure' "$out/closure.txt")
}

# --- 2: no effect --------------------------------------------------------------------------------------------------------
figure_2() {
  selftest closure-tracks-null "$((seeds > 30 ? (seeds + 11) / 12 : 1))"
  local false_ones n input which
  IFS=$'\t' read -r _ false_ones n < <(grep '^closure-tracks-false' "$out/closure-tracks-null.txt")
  judge 2t "$false_ones of $n" "3 of 300" "false adoptions on tracks: shaken and wind, with and without background, readout 0, 0.7, 1 of a frame" \
    "$false_ones <= 0.01 * $n"
  line 2t beside "$(awk -F'\t' '$1 == "closure-tracks-null" { if ($7 > w) { w = $7; who = $8 } if ($9 > l) l = $9 }
    END { printf "named %.4f (%s), latent %.4f of the noise", w, who, l }' "$out/closure-tracks-null.txt")" \
    "bars 0.02, 0.005, 0.003" "largest share that was refused"
  selftest closure-series-null "$((seeds / 2))"
  while IFS=$'\t' read -r _ input n false_ones which; do
    judge "2.series.$input" "$false_ones of $n${which:+: $which}" "<= 1 %" "false adoptions in series of channels, $input" "$false_ones <= 0.01 * $n"
  done < <(grep '^series-null' "$out/closure-series-null.txt")
  selftest closure-null "$seeds"
  false_ones=$(awk -F'\t' '$2 == "none" { print $3 - $9 }' "$out/closure-null.txt")
  judge 2s "$false_ones of $seeds" "3 of 300" "false adoptions at the structure level, uniform frames with noise" \
    "$false_ones <= 0.01 * $seeds"
}

# --- 3: an effect outside the catalogue ----------------------------------------------------------------------------------
figure_3() {
  selftest closure-tracks-outside "$few"
  local effect n latent half modal names
  while IFS=$'\t' read -r effect n latent half modal names; do
    judge "3.${effect// /_}" "latent in $latent of $n, half of the named effect's gain in $half, modal error not worse in $modal" "all" \
      "not in the catalogue; reported: $names" "$latent == $n && $half == $n && $modal == $n"
  done < <(outside_cells)
}
outside_cells() { # a line per effect, from the records' lines
  python3 - "$out/closure-tracks-outside.txt" <<'PY'
import collections, sys
cells = collections.OrderedDict()
for row in open(sys.argv[1]):
    f = row.rstrip("\n").split("\t")
    if f[0] == "closure-tracks-outside":
        cells.setdefault(f[1], []).append(f)
for effect, rows in cells.items():
    latent = [r for r in rows if r[4].startswith("latent") and all(n.startswith("latent") for n in r[4].split(" + "))]
    half = [r for r in rows if float(r[5]) ** 2 - float(r[6]) ** 2 >= 0.5 * (float(r[5]) ** 2 - float(r[8]) ** 2)]
    modal = [r for r in rows if float(r[10]) <= 1.05 * float(r[9]) + 0.01]
    names = collections.Counter(r[4] for r in rows)
    print(effect, len(rows), len(latent), len(half), len(modal), "; ".join(f"{k} x{v}" for k, v in names.most_common()), sep="\t")
PY
}

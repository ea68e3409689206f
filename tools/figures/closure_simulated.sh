# Figures 1 and 2 of residual diagnosis: simulated records with an undeclared effect, and with none. Sourced by closure.sh.

# --- 1: undeclared effects -----------------------------------------------------------------------------------------------
figure_1() {
  figure_1_tracks
  figure_1_pairs
  figure_1_series
  figure_1_structures
}
figure_1_tracks() {
  validate closure-tracks "$known"
  grep '^# bars' "$out/closure-tracks.txt"
  echo "# confusion: effect, strength, what was named, records"
  awk -F'\t' '$1 == "closure-tracks" { n[$2 "\t" $4 "\t" $10]++ } END { for (k in n) print "#\t" k "\t" n[k] }' "$out/closure-tracks.txt" | sort
  local effect strength n exact within after bias visible before modal twin share most right parameter what
  while IFS=$'\t' read -r effect strength n exact within after bias visible before modal twin; do
    share=0.95 most=1.1 right="$within >= $exact" parameter="parameters within 3 sigma"
    [ "$effect" != "readout time" ] || right="$bias <= 0.03 && $bias >= -0.03" parameter="bias at most 0.03 of a frame"
    [ "$effect" != "rotor line" ] || share=0.90
    [[ $effect != "camera yaw" && $effect != "roll above 5 Hz" ]] || most=1.25
    what="effect / noise $strength rms, beyond the free motions $visible; modal error $before -> $modal %, without the effect $twin % (median rms)"
    if [ "$strength" = 0.2 ]; then
      line "1.${effect// /_}.$strength" beside "alone and right $exact of $n, all parameters within 3 sigma $within, after $after of the floor" "-" "$what"
    else
      judge "1.${effect// /_}.$strength" "alone and right $exact of $n, all parameters within 3 sigma $within, after $after of the floor, bias $bias" \
        "named correctly, nothing else named, in $share; $parameter; held-out after at most $most times the floor" "$what" \
        "$exact >= $share * $n && $after <= $most && $right"
    fi
  done < <(tracks_cells)
}
tracks_cells() { # a line per effect and strength, from the lines of the records
  cells "$out/closure-tracks.txt" closure-tracks 1,3 <<'PY'
exact = [r for r in rows if r[9] == r[2]]
within = [r for r in exact if float(r[13]) <= 3.0]
after = [float(r[11]) / float(r[12]) for r in rows]
worst = float("nan") if any(map(math.isnan, after)) else max(after)
bias = statistics.mean(float(r[14]) for r in exact) if exact else float("nan")
put(*key, len(rows), len(exact), len(within), f"{worst:.3f}", f"{bias:.4g}", f"{middle(6):.3f}", *(f"{middle(i):.3f}" for i in (15, 16, 17)))
PY
}
figure_1_pairs() {
  validate closure-tracks-pairs "$known"
  local pair n both more
  while IFS=$'\t' read -r pair n both more; do
    judge "1p.${pair// /_}" "both and nothing else in $both of $n, both and more in $more" "both named (and nothing else) in 0.85" \
      "two effects, each of strength 1" "$both >= 0.85 * $n"
  done < <(cells "$out/closure-tracks-pairs.txt" closure-tracks-pair 1 <<'PY'
truth, named = set(key[0].split(" + ")), [set(r[4].split(" + ")) for r in rows]
put(*key, len(rows), sum(truth == n for n in named), sum(truth < n for n in named))
PY
  )
}
figure_1_series() {
  validate closure-series "$known"
  local effect strength n alone with wrong nothing within number before after condition bar
  while IFS=$'\t' read -r effect strength n alone with wrong nothing within number before after; do
    case $effect in
      frequency_drift | softening) bar="found in 0.90" condition="$alone + $with >= 0.9 * $n" ;;
      duplicated_frames) bar="named correctly, nothing else named, in 0.95; parameter within 3 sigma" condition="$alone >= 0.95 * $n && $within >= $alone + $with" ;;
      *) bar="named correctly, nothing else named, in 0.90; parameter within 3 sigma" condition="$alone >= 0.9 * $n && $within >= $alone + $with" ;;
    esac
    judge "1.$effect.${strength// /_}" "$alone of $n named alone ($with with another, $wrong another, $nothing nothing); within 3 sigma $within; stated / true $number (median); held-out innovations $before -> $after" \
      "$bar" "$effect of $strength in 120 s of channels" "$condition"
  done < <(series_cells)
}
series_cells() { # a line per effect and strength, from the lines of the records
  cells "$out/closure-series.txt" series 1,2 <<'PY'
effect = key[0]
named = [r for r in rows if effect in r[4].split(" + ")]
alone, nothing = sum(r[4] == effect for r in rows), sum(r[4] == "nothing" for r in rows)
ratios = [float(r[6]) / float(r[5]) for r in named if float(r[5]) != 0.0]
within = sum(float(r[7]) <= 3.0 for r in named)
unstated = sum(math.isinf(float(r[7])) for r in named)
number = (f"{statistics.median(ratios):.3f}" if ratios else "nan") + (f", no sigma stated in {unstated}" if unstated else "")
put(*key, len(rows), alone, len(named) - alone, len(rows) - len(named) - nothing, nothing, within, number,
    *(f"{statistics.mean(float(r[i]) for r in rows):.4f}" for i in (8, 9)))
PY
}
figure_1_structures() {
  validate closure "$known"
  local effect n rms alone first_of among wrong nothing within
  while IFS=$'\t' read -r _ effect n rms alone first_of among wrong nothing within; do
    judge "1s.$effect" "named $((alone + first_of)) (alone $alone), among the rivals $among, wrong $wrong, nothing $nothing of $n; of those named all parameters within 3 sigma $within" \
      "named correctly (or among the rivals that are named), nothing else named, in 0.95; parameters within 3 sigma" "residual $rms % rms without it" \
      "$alone + $first_of + $among >= 0.95 * $n && $within >= $alone + $first_of"
  done < <(grep '^closure' "$out/closure.txt")
}

# --- 2: no effect --------------------------------------------------------------------------------------------------------
figure_2() {
  figure_2_tracks
  figure_2_series
  figure_2_structures
}
figure_2_tracks() {
  local false_ones n
  validate closure-tracks-null "$(((seeds + 11) / 12))"
  IFS=$'\t' read -r _ false_ones n < <(grep '^closure-tracks-false' "$out/closure-tracks-null.txt")
  judge 2t "$false_ones of $n" "at most 3 false adoptions of 300, named and latent together" \
    "tracks: shaken and wind-driven, with and without background, readout 0, 0.7 and 1 of a frame" "$false_ones <= 0.01 * $n"
  line 2t beside "$(awk -F'\t' '$1 == "closure-tracks-null" { if ($7 > w) { w = $7; who = $8 } if ($9 > l) l = $9 }
    END { printf "named %.4f (%s), latent %.4f of the noise", w, who, l }' "$out/closure-tracks-null.txt")" \
    "published materiality: 0.02, 0.005, 0.003" "largest share that was refused"
}
figure_2_series() {
  local n false_ones which
  validate closure-series-null "$(((seeds + 1) / 2))"
  IFS=$'\t' read -r n false_ones which < <(awk -F'\t' '$1 == "series-null" { n++; if ($4 != "nothing") { f++; which = which " " $2 ": " $4 ";" } }
    END { print n "\t" f + 0 "\t" which }' "$out/closure-series-null.txt")
  judge 2.series "$false_ones of $n${which:+:$which}" "at most 3 false adoptions of 300" "series of channels, shaken and wind-driven" "$false_ones <= 0.01 * $n"
}
figure_2_structures() {
  local false_ones
  validate closure-null "$seeds"
  false_ones=$(awk -F'\t' '$2 == "none" { print $3 - $9 }' "$out/closure-null.txt")
  judge 2s "$false_ones of $seeds" "at most 3 false adoptions of 300" "uniform frames with noise" "$false_ones <= 0.01 * $seeds"
}

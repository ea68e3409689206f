# Figure 3 of residual diagnosis: effects that the catalogue lacks. Sourced by closure.sh.

# --- 3: an effect outside the catalogue ----------------------------------------------------------------------------------
figure_3() {
  figure_3_tracks
  figure_3_series
}
figure_3_tracks() {
  validate closure-tracks-outside "$few"
  local effect n latent half described modal names
  while IFS=$'\t' read -r effect n latent half described modal names; do
    judge "3.${effect// /_}" "latent (or with its rivals) in $latent of $n, half of the named effect's gain in $half, described as it is in $described, modal error not worse in $modal" \
      "reported as latent, half of the named effect's gain, description true, modal error not worse than before; a wrong single name is a miss" \
      "not in the catalogue, strength 1; reported: $names" "$latent == $n && $half == $n && $described == $n && $modal == $n"
  done < <(outside_cells)
}
outside_cells() { # a line per effect, from the lines of the records
  cells "$out/closure-tracks-outside.txt" closure-tracks-outside 1 <<'PY'
latent, described = (sum(r[i] == "1" for r in rows) for i in (6, 7))
def half(before, after, named):
    return before ** 2 - after ** 2 >= 0.5 * (before ** 2 - named ** 2)
lowered = sum(half(float(r[8]), float(r[9]), float(r[11])) for r in rows)
modal = sum(float(r[13]) <= float(r[12]) for r in rows)
names = collections.Counter(r[5] for r in rows)
put(*key, len(rows), latent, lowered, described, modal, "; ".join(f"{k} x{v}" for k, v in names.most_common()))
PY
}
figure_3_series() {
  validate closure-series-outside "$few"
  local effect n latent half names
  while IFS=$'\t' read -r effect n latent half names; do
    judge "3.$effect" "latent in $latent of $n, half of the named effect's gain in $half" \
      "reported as latent, half of the named effect's gain; a wrong single name is a miss" "not in the catalogue, series of channels; reported: $names" \
      "$latent == $n && $half == $n"
  done < <(cells "$out/closure-series-outside.txt" series-outside 1 <<'PY'
latent = sum(r[5] == "1" for r in rows)
half = sum(float(r[6]) ** 2 - float(r[7]) ** 2 >= 0.5 * (float(r[6]) ** 2 - float(r[8]) ** 2) for r in rows)
names = collections.Counter(r[4] for r in rows)
put(*key, len(rows), latent, half, "; ".join(f"{k} x{v}" for k, v in names.most_common()))
PY
  )
}

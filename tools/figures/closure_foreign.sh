# Figures 10 to 13 of residual diagnosis, tracks: records not simulated by the model's formulas (tools/validate/foreign_scene.h).
# Sourced by closure.sh.

foreign() { # NAME SEEDS ...: validate with the recorded hover, if it is available
  local name=$1 n=$2 use_flight=()
  shift 2
  if [ -f "$data/phantom4_hover/flight_10hz.csv" ]; then use_flight=(--flight "$data/phantom4_hover/flight_10hz.csv"); fi
  validate "$name" "$n" "${use_flight[@]}" "$@"
}
recorded_or_not() { [ -f "$data/phantom4_hover/flight_10hz.csv" ] && echo "the recorded hover among them" || echo "without the recorded hover (no data at $data)"; }

# --- 10: nulls that are not ideal ----------------------------------------------------------------------------------------
figure_10() {
  figure_10_tracks
  figure_10_clips
  figure_10_demo
}
figure_10_tracks() {
  local false_ones n
  foreign closure-tracks-foreign-null "$seeds"
  IFS=$'\t' read -r _ false_ones n < <(grep '^closure-tracks-foreign-false	' "$out/closure-tracks-foreign-null.txt")
  awk -F'\t' '$1 ~ /^closure-tracks-foreign-(adopted|false-of)$/ { print "#\t" $1 "\t" $2 "\t" $3 }' "$out/closure-tracks-foreign-null.txt"
  judge 10t "$false_ones of $n adopt: $(awk -F'\t' '$1 == "closure-tracks-foreign-adopted" { printf "%s%s x%s", s, $2, $3; s = "; " }' "$out/closure-tracks-foreign-null.txt")" \
    "300 records: at most 3 adopt anything" \
    "hover tails f^-3 to f^-5, corner .05-.5 Hz, shake table and wind, readout 0-1, noise unequal and unknown, 4-8 storeys, 24-60 fps, modes that fold; $(recorded_or_not)" \
    "$false_ones <= 0.01 * $n"
}

# --- 11: every effect, drawn per seed ------------------------------------------------------------------------------------
figure_11() { figure_11_tracks; }
figure_11_tracks() {
  foreign closure-tracks-foreign "$few"
  echo "# answers: effect, strength, what was adopted, records"
  awk -F'\t' '$1 == "closure-tracks-foreign" { n[$2 "\t" $3 "\t" $10]++ } END { for (k in n) print "#\t" k "\t" n[k] }' "$out/closure-tracks-foreign.txt" | sort
  local effect strength n named latent misnamed nothing covered values kept raised undone what bar condition
  while IFS=$'\t' read -r effect strength n named latent misnamed nothing; do
    what="strength $strength; named $named, latent $latent, misnamed $misnamed, nothing $nothing of $n"
    if [ "$strength" = 0.2 ]; then
      bar="at 0.2 named, latent or nothing, never misnamed in > 3 %" condition="$misnamed <= 0.03 * $n"
    else
      bar="at 1 and 5 named and nothing else in >= 90 %" condition="$named >= 0.9 * $n"
    fi
    judge "11.${effect// /_}.$strength" "$what" "$bar" "$effect" "$condition"
  done < <(foreign_cells)
  IFS=$'\t' read -r n covered values kept raised undone < <(foreign_totals)
  judge 11.intervals "$covered of $values parameters" "95 % intervals hold 90-98 %" "known parameters of right names, all effects" \
    "$values > 0 && $covered >= 0.9 * $values && $covered <= 0.98 * $values"
  judge 11.modes "$kept of $n records" "modal error after <= 1.02 times before in 95 % of records" "all effects and strengths" "$kept >= 0.95 * $n"
  judge 11.rise "$undone of the rise undone (median of $raised records)" \
    "for effects that raise it by half or more: at least half of the rise undone in the median" "records whose modal error is 1.5 times that without the effect" \
    "$raised > 0 && $undone >= 0.5"
}
foreign_cells() { # prints a line per effect and strength
  python3 - "$out/closure-tracks-foreign.txt" <<'PY'
import collections, sys
cells = collections.OrderedDict()
for row in open(sys.argv[1]):
    f = row.rstrip("\n").split("\t")
    if f[0] == "closure-tracks-foreign":
        cells.setdefault((f[1], f[2]), []).append(f[8])
for (effect, strength), answers in cells.items():
    print(effect, strength, len(answers), *(answers.count(a) for a in ("named", "latent", "misnamed", "nothing")), sep="\t")
PY
}
foreign_totals() {
  python3 - "$out/closure-tracks-foreign.txt" <<'PY'
import math, statistics, sys
n = kept = covered = values = 0
undone = []
for row in open(sys.argv[1]):
    f = row.rstrip("\n").split("\t")
    if f[0] != "closure-tracks-foreign":
        continue
    if f[13] != "-" and f[8] == "named":
        z = [float(x) for x in f[13].split()]
        values, covered = values + len(z), covered + sum(abs(x) <= 1.96 for x in z)
    before, after, twin = (float(x) for x in f[14:17])
    if math.isnan(before):  # no mode before: none can be lost
        continue
    n, kept = n + 1, kept + (after <= 1.02 * before)
    if before >= 1.5 * twin:
        undone.append((before - after) / (before - twin))
print(n, covered, values, kept, len(undone), f"{statistics.median(undone):.3f}" if undone else "nan", sep="\t")
PY
}

# --- 12: pairs and triples -------------------------------------------------------------------------------------------------
figure_12() {
  foreign closure-tracks-foreign-sets "$(((seeds * 2 + 2) / 3))"
  local size n named part misnamed latent nothing share
  while IFS=$'\t' read -r size n named part latent misnamed nothing; do
    share=$([ "$size" = 2 ] && echo 0.85 || echo 0.7)
    judge "12.$size" "$named of $n (part $part, with latent $latent, misnamed $misnamed, nothing $nothing)" \
      "all named and nothing else in 85 % (pairs), 70 % (triples)" "$size effects of strength 1 drawn at random" "$named >= $share * $n"
  done < <(python3 - "$out/closure-tracks-foreign-sets.txt" <<'PY'
import collections, sys
cells = collections.defaultdict(list)
for row in open(sys.argv[1]):
    f = row.rstrip("\n").split("\t")
    if f[0] == "closure-tracks-foreign-sets":
        cells[f[1].count(" + ") + 1].append(f[8])
for size, answers in sorted(cells.items()):
    print(size, len(answers), *(answers.count(a) for a in ("named", "part", "latent", "misnamed", "nothing")), sep="\t")
PY
  )
}

# --- 13: left out of the catalogue ---------------------------------------------------------------------------------------
figure_13() {
  foreign closure-tracks-foreign-outside "$few"
  local effect n latent half described misnamed names
  while IFS=$'\t' read -r effect n latent half described misnamed names; do
    judge "13.${effect// /_}" "latent in $latent of $n, half of the named effect's gain in $half, described as it is in $described, misnamed $misnamed" \
      "latent, true words, residual lowered by half of what the name achieves, never misnamed in > 5 %" "strength 1; reported: $names" \
      "$latent == $n && $half == $n && $described == $n && $misnamed <= 0.05 * $n"
  done < <(python3 - "$out/closure-tracks-foreign-outside.txt" <<'PY'
import collections, sys
cells = collections.OrderedDict()
for row in open(sys.argv[1]):
    f = row.rstrip("\n").split("\t")
    if f[0] == "closure-tracks-foreign-outside":
        cells.setdefault(f[1], []).append(f)
def half(before, after, named):
    return before ** 2 - after ** 2 >= 0.5 * (before ** 2 - named ** 2)
for effect, rows in cells.items():
    latent, described = (sum(r[i] == "1" for r in rows) for i in (6, 7))
    lowered = sum(half(float(r[8]), float(r[9]), float(r[11])) for r in rows)
    misnamed = sum(any(not name.startswith("latent") for name in r[5].split(" + ")) and r[5] != "nothing" and r[6] != "1" for r in rows)
    names = collections.Counter(r[5] for r in rows)
    print(effect, len(rows), latent, lowered, described, misnamed, "; ".join(f"{k} x{v}" for k, v in names.most_common()), sep="\t")
PY
  )
}

# Figure 14 of residual diagnosis: displacements measured from tracks, with row delays. Sourced by closure.sh.

figure_14() {
  figure_14_effects
  figure_14_null
}
figure_14_effects() {
  validate closure-series-tracked "$few"
  echo "# confusion: case, strength, what was named, records"
  awk -F'\t' '$1 == "series-tracked" { n[$2 "\t" $3 "\t" $5]++ } END { for (k in n) print "#\t" k "\t" n[k] }' \
    "$out/closure-series-tracked.txt" | sort
  local name strength n named alone within held nearer repaired pole frequency what
  while IFS=$'\t' read -r name strength n named alone within held nearer repaired pole frequency; do
    what="$name $strength, 120 s of tracks, $(seeds_of "$n"): sigma stated in $held of $named, number within 3 of it in $within; repaired modes nearer in $nearer of $repaired; poles $pole %, frequencies $frequency % (median rms, before -> after)"
    case "$name $strength" in
      "softening 3 %" | "drift 1 %")
        line "14.${name// /_}.${strength// /_}" beside "named in $named of $n, alone in $alone" "-" "$what" ;;
      *)
        judge "14.${name// /_}.${strength// /_}" "named in $named of $n, alone in $alone" "named in 90 % from 6 % / 2 % on" "$what" \
          "$named >= 0.9 * $n && $n > 0" ;;
    esac
  done < <(tracked_cells)
  local near all
  read -r near all < <(awk -F'\t' '$1 == "series-tracked" && $9 > 0 { n++; if ($11 < $10) m++ } END { print m + 0, n + 0 }' \
    "$out/closure-series-tracked.txt")
  judge 14n "nearer in $near of $all records in which something was repaired" "repaired modes nearer to the truth in 95 %" \
    "rms distance of the identified poles (frequency and damping) from the true ones, after the repair against before" \
    "$near >= 0.95 * $all && $all > 0"
}
tracked_cells() { # a line per case and strength, from the lines of the records
  python3 - "$out/closure-series-tracked.txt" <<'PY'
import collections, math, statistics, sys
CALLED = {"drift": "frequency_drift", "jitter": "time_stamp_jitter", "drops": "dropped_frames", "variable rate": "dropped_frames",
          "repeats": "duplicated_frames", "insertions": "duplicated_frames"}
cells = collections.OrderedDict()
for row in open(sys.argv[1]):
    f = row.rstrip("\n").split("\t")
    if f[0] == "series-tracked":
        cells.setdefault((f[1], f[2]), []).append(f)
def middle(rows, i):
    values = [float(r[i]) for r in rows if not math.isnan(float(r[i]))]
    return statistics.median(values) if values else float("nan")
for (name, strength), rows in cells.items():
    effect = CALLED.get(name, name)
    named = [r for r in rows if effect in r[4].split(" + ")]
    alone = [r for r in named if r[4] == effect]
    held = [r for r in named if not math.isnan(float(r[7]))]
    within = [r for r in held if abs(float(r[6]) - float(r[5])) <= max(3 * float(r[7]), 1e-9)]
    repaired = [r for r in rows if int(r[8]) > 0]
    nearer = [r for r in repaired if float(r[10]) < float(r[9])]
    print(name, strength, len(rows), len(named), len(alone), len(within), len(held), len(nearer), len(repaired),
          *(f"{middle(repaired, i):.3f} -> {middle(repaired, i + 1):.3f}" for i in (9, 11)), sep="\t")
PY
}
figure_14_null() {
  validate closure-series-tracked-null "$seeds"
  local n wrong
  read -r n wrong < <(awk -F'\t' '$1 == "series-tracked-null" { n++; if ($4 != "nothing") m++ } END { print n + 0, m + 0 }' \
    "$out/closure-series-tracked-null.txt")
  awk -F'\t' '$1 == "series-tracked-null" { n[$2 "\t" $4]++ } END { for (k in n) print "#\t" k "\t" n[k] }' \
    "$out/closure-series-tracked-null.txt" | sort
  judge 14f "$wrong of $n" "false names in 300 other records <= 3" \
    "records of tracks without an effect in clock or structure, $(seeds_of "$n"): none, rolling gusts, oblique view, fast hover, rotors, shimmer" \
    "$n > 0 && $wrong <= 3 * $n / 300"
}

#!/usr/bin/env bash
# The figures of closing the loop: residual, effect, error before and after. One line a figure.
#   tools/figures/closure.sh [--quick]      --quick takes a tenth of the seeds
# Reports stay in build/figures/closure. SKIP where measured data (HOVERMODAL_DATA) are absent.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
seeds=300 known=40
[ "${1:-}" != --quick ] || { seeds=30 known=4; }
out=build/figures/closure
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh hovermodal

# closeloop NAME ARGUMENTS...: report in $out/NAME, text in $out/NAME.txt
closeloop() {
  local name=$1
  shift
  rm -rf "${out:?}/$name"
  "$bin/hovermodal" closeloop "$@" --report "$out/$name" >"$out/$name.txt" 2>"$out/$name.log" || { cat "$out/$name.log" >&2; return 1; }
}
# ask NAME PYTHON: an expression over the closure.json `c`; steps by name in `s`
ask() {
  python3 - "$out/$1/closure.json" "$2" <<'PY'
import json, math, sys
c = json.load(open(sys.argv[1]))
s = {step["effect"]: step for step in c["steps"]}
def rms(values):
    values = list(values)
    return math.sqrt(sum(v * v for v in values) / len(values)) if values else float("nan")
def errors(key, name="error_percent"):
    return [m[name] for m in c[key] if m[name] is not None]
def worst(key):
    return max(abs(e) for e in errors(key))
def told():
    return "; ".join(f'{e["effect"]} ({e["heldout_before"]:.2f} -> {e["heldout_after"]:.2f} %' +
        (", cannot be told from " + ", ".join(e["rivals"]) if e["rivals"] else "") + ")" for e in c["steps"]) or "nothing"
print(eval(sys.argv[2]))
PY
}
frame() { printf 'structure: {kind: shear_frame, %s}\n' "$2" >"$out/$1.yaml"; }
table() { printf 'frequency_hz\n' >"$out/$1.csv"; printf '%s\n' "${@:2}" >>"$out/$1.csv"; }

# --- 4: structures -----------------------------------------------------------------------------------------------------
frame paper "storeys: 6"
table paper 1.657 5.04 8.14 10.83 12.93 14.34
table paper_accelerometer 1.632 5.054 8.175
closeloop paper --structure "$out/paper.yaml" --reference "$out/paper.csv" --check "$out/paper_accelerometer.csv"
read -r before worst after < <(ask paper 'f"""{c["baseline"]["residual_rms"]:.2f} {worst("modes_before"):.2f} {rms(errors("modes_after")):.3f}"""')
judge 4a "before $before % rms, $worst % worst; after $after % rms: $(ask paper 'told()')" "2.3, 4.3 %; 0.25 %" \
  "six stated frequencies against a uniform shear frame" \
  "$before > 2.25 && $before < 2.36 && $worst > 4.2 && $worst < 4.4 && $after <= 0.25"
sound=$(ask paper 'int("gravity_softening" in s and len(s) == 2 and all(not (name in ("ground_storey", "roof_mass") and not ({"ground_storey", "roof_mass"} - {name}) <= set(e["rivals"])) for name, e in s.items()))')
falls=$(ask paper 'int(all(e["heldout_after"] < e["heldout_before"] for e in c["steps"]))')
height=$(ask paper 'f"""{9806.65 / s["gravity_softening"]["parameters"]["gravity_over_height"]["value"]:.0f}""" if "gravity_softening" in s else "nan"')
judge 4b "storey height implied $height mm, partner named with its rivals: $sound, leave-one-out error fell at each step: $falls" \
  "80 - 160 mm, 1, 1" "parameters plausible; ground storey and roof mass not told apart" \
  "$height >= 80 && $height <= 160 && $sound == 1 && $falls == 1"
line 4c beside "$(ask paper 'f"""{c["reference_error_before"]:.2f} -> {c["reference_error_after"]:.2f} % rms"""'): $(grep -A 4 'no fit saw (--check)' "$out/paper.txt" | tail -n +2 | awk '{ printf "%s Hz %s %%  ", $3, $4 }')" \
  "-" "the accelerometers' three frequencies, which no fit saw"

if [ -d "$data/mini_shake_table" ]; then
  rm -rf "$out/shake_identified"
  quietly "$bin/hovermodal" identify --series "$data/mini_shake_table/flexible_northridge.csv" --input ground_m_s2 \
    --max-frequency 24 --report "$out/shake_identified"
  frame shake "storeys: 3, floors: [floor1_m_s2, floor2_m_s2, floor3_m_s2]"
  closeloop shake --structure "$out/shake.yaml" --reference "$out/shake_identified/modal.json"
  judge 4d "frequency $(ask shake 'f"""{c["baseline"]["residual_rms"]:.2f} -> {rms(errors("modes_after")):.2f} % rms, MAC {min(errors("modes_before", "mac")):.4f} -> {min(errors("modes_after", "mac")):.4f} (least)"""'): $(ask shake 'told()')" \
    "at most one effect" "three-storey frame on a shake table, frequencies and shapes" "$(ask shake 'len(c["steps"])') <= 1"
else
  line 4d SKIP "-" "-" "no $data/mini_shake_table"
fi

# --- 5: a published simulation against its stated truth ----------------------------------------------------------------
if [ -d "$data/published_shear_frame" ]; then
  rm -rf "$out/published_identified"
  quietly "$bin/hovermodal" identify --series "$data/published_shear_frame/accelerations.csv" --quantity a \
    --max-frequency 2 --report "$out/published_identified"
  # The stated truth 1.13852 3.32332 5.23889 6.73003 7.67594 rad/s is the uniform frame of k / m = 16 / s^2.
  frame published "storeys: 5, stiffness_over_mass_per_s2: 16, data: simulated, dt_s: 0.083333333"
  closeloop published --structure "$out/published.yaml" --reference "$out/published_identified/modal.json"
  frame published_free "storeys: 5, stiffness_over_mass_per_s2: 16, data: simulated"
  closeloop published_free --structure "$out/published_free.yaml" --reference "$out/published_identified/modal.json"
  read -r first others < <(ask published 'f"""{abs(errors("modes_after")[0]):.3f} {max(abs(e) for e in errors("modes_after")[1:]):.3f}"""')
  judge 5a "worst $(ask published 'f"""{worst("modes_before"):.2f}"""') % before; after: mode 1 $first %, others $others %: $(ask published 'told()')" \
    "0.6, 0.3 %, traced to the integrator" "published simulation against its stated truth, step known" \
    "$first <= 0.6 && $others <= 0.3 && $(ask published 'int(list(s) == ["integrator"])') == 1"
  line 5b beside "$(ask published_free 'told()'); $(ask published_free '", ".join(f"""{n} {p["value"]:.4f} +- {p["sigma"] or 0:.4f} {p["unit"]}""" for e in c["steps"] for n, p in e["parameters"].items())')" \
    "-" "the same, step not known (true 0.0833 s)"
else
  for number in 5a 5b; do line "$number" SKIP "-" "-" "no $data/published_shear_frame"; done
fi

# --- structures made up: one effect, or none ---------------------------------------------------------------------------
"$bin/hovermodal" selftest closure --seeds "$known" >"$out/known.txt"
"$bin/hovermodal" selftest closure-null --seeds "$seeds" >"$out/null.txt"
false_ones=$(awk -F'\t' '$2 == "none" { print $3 - $9 }' "$out/null.txt")
judge 2s "$false_ones of $seeds" "3 of 300" "false adoptions at the structure level, uniform frames with noise" \
  "$false_ones <= 0.01 * $seeds"
while IFS=$'\t' read -r _ effect n rms alone first among wrong nothing; do
  [ "$effect" != none ] || continue
  judge "1s.$effect" "named $((alone + first)) (alone $alone), among the rivals $among, wrong $wrong, nothing $nothing of $n" \
    "true effect named or among those not told apart in 95 %" "residual $rms % rms without it" "$alone + $first + $among >= 0.95 * $n"
done < <(grep '^closure' "$out/known.txt")

[ "$misses" -eq 0 ] || { echo "$misses figures miss their bar" >&2; exit 1; }

#!/usr/bin/env bash
# The figures of closing the loop: residual, effect, error before and after. One line a figure.
#   tools/figures/closure.sh [--quick] [--seeds N] [--first-seed N] [FIGURE...]
# FIGURE: some of 1 ... 11, 11b, 12, 13, 14, 15 (default: all), or parts of 1 to 3 and 10: 1_tracks 1_pairs 1_series 1_structures
# 2_tracks 2_series 2_structures 3_tracks 3_series 10_tracks 10_clips 10_demo. --quick takes a tenth of the seeds, --seeds so
# many for each case; they begin with --first-seed (1001: those that nobody looked at while the loop was made).
# Reports stay in build/figures/closure. SKIP where measured data (HOVERMODAL_DATA) are absent.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/closure.sh [--quick] [--seeds N] [--first-seed N] [FIGURE...]" "$@"
seeds=300 known=40 few=20 clip_s=60 null_clips=40 effect_clips=20 coded_clips=10
[ -z "$quick" ] || seeds=30 known=4 few=2 clip_s=40 null_clips=2 effect_clips=2 coded_clips=1
[ -z "$n_seeds" ] || seeds=$n_seeds known=$n_seeds few=$n_seeds
[ ${#figures[@]} -gt 0 ] || figures=(1 2 3 4 5 6 7 8 9 10 11 11b 12 13 14 15)
out=build/figures/closure
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh hovermodal hovermodald hovermodal-validate

validate() { # NAME SEEDS ...: the table of a self-test, in $out/NAME.txt
  local name=$1 n=$2
  shift 2
  "$bin/hovermodal-validate" "$name" --first-seed "$first_seed" --seeds "$n" --threads "$(nproc)" "$@" >"$out/$name.txt"
}
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
def modes_hz(key):
    return " ".join(f'{m["frequency_hz"]:.2f}' for m in c[key]) or "none"
def macs(key):
    return " ".join(f'{m["mac"]:.3f}' for m in c[key] if m["mac"] is not None) or "none"
def common_macs():
    after = {m["reference_hz"]: m["mac"] for m in c["modes_after"]}
    pairs = [(m["mac"], after[m["reference_hz"]]) for m in c["modes_before"]
             if m["mac"] is not None and after.get(m["reference_hz"]) is not None]
    return [f"{min(values):.4f}" for values in zip(*pairs)] or ["nan", "nan"]
def common():
    after = {m["reference_hz"]: m["error_percent"] for m in c["modes_after"]}
    return [(m["error_percent"], after[m["reference_hz"]]) for m in c["modes_before"]
            if m["error_percent"] is not None and after.get(m["reference_hz"]) is not None]
def told():
    return "; ".join(f'{e["effect"]} ({e["heldout_before"]:.2f} -> {e["heldout_after"]:.2f} %' +
        (", cannot be told from " + ", ".join(e["rivals"]) if e["rivals"] else "") + ")" for e in c["steps"]) or "nothing"
try:
    print(eval(sys.argv[2]))
except (KeyError, TypeError, ValueError, ZeroDivisionError, IndexError):  # a number that the report does not contain
    print("nan")
PY
}

. tools/figures/closure_simulated.sh
. tools/figures/closure_outside.sh
. tools/figures/closure_structure.sh
. tools/figures/closure_response.sh
. tools/figures/closure_series_tracked.sh
. tools/figures/closure_camera.sh
. tools/figures/closure_foreign.sh
. tools/figures/closure_foreign_clips.sh
. tools/figures/closure_codec.sh
rm -f "$out"/*/closure.json # so that the table contains only this run
after_figures() { [ -z "$(ls "$out"/*/closure.json 2>/dev/null)" ] || tools/figures/closure_table.py "$out"; }
run_figures "${figures[@]}"

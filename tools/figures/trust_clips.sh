#!/usr/bin/env bash
# The paper's experiment as compressed clips: what H.264 does to the modes. One line a figure.
#   tools/figures/trust_clips.sh [--quick] [--first-seed N] [FIGURE...]      FIGURE: 2b_60 2b_300 (default: all)
# --quick takes two seeds; 2b_300 is left out then. Per seed and length a clip is drawn uncompressed and encoded at 0.05, 0.15
# and 0.4 bits a pixel; the service runs on all four. Their modes stay in build/figures/trust_clips, clips are deleted after
# each run (16 GB are needed for one of 300 s); a run that was cut off goes on after its last whole seed. libx264's preset
# superfast draws worse at the same rate than slower ones.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/trust_clips.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
if [ -n "$quick" ]; then all_or_named 2b_60; else all_or_named 2b_60 2b_300; fi
seeds=10 rates=(0.05 0.15 0.4)
[ -z "$quick" ] || seeds=2
out=build/figures/trust_clips
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh hovermodald hovermodal

# encode: $out/drawn/clip.y4m by libx264 at each of the rates (bits a pixel), in $out/RATE.mp4.
encode() {
  local size bits outputs=()
  size=$(ffprobe -v error -select_streams v -show_entries stream=width,height -of csv=p=0 "$out/drawn/clip.y4m")
  for bits in "${rates[@]}"; do
    outputs+=(-c:v libx264 -preset superfast -b:v "$(awk "BEGIN { printf \"%.0f\", $bits * ${size/,/ * } * 25 }")" -pix_fmt yuvj420p "$out/$bits.mp4")
  done
  quietly ffmpeg -nostdin -y -i "$out/drawn/clip.y4m" "${outputs[@]}"
}
# score FOLDER: modes found within 2 %, structural poles that are none, least MAC, rms of the frequencies' errors in stated sigma.
score() {
  python3 -B - "$1/modal.json" "$out/drawn/truth.json" <<'PY'
import json, sys
result, truth = (json.load(open(path)) for path in sys.argv[1:])
def alike(mode, true):
    names = [name for name in true["shape"] if name in mode["shape"] and name != "base"]
    a = [complex(*mode["shape"][name]) for name in names]
    b = [true["shape"][name] for name in names]
    inner = sum(x * y for x, y in zip(a, b))
    return abs(inner) ** 2 / (sum(abs(x) ** 2 for x in a) * sum(y * y for y in b))
found, macs, errors = set(), [], []
for mode in result["modes"]:
    i, true = min(enumerate(truth["modes"]), key=lambda one: abs(one[1]["frequency_hz"] - mode["frequency_hz"]))
    off = mode["frequency_hz"] - true["frequency_hz"]
    if abs(off) > 0.02 * true["frequency_hz"] or i in found:
        continue
    found.add(i)
    macs.append(alike(mode, true))
    if mode["frequency_std_hz"]:
        errors.append(off / mode["frequency_std_hz"])
rms = (sum(e * e for e in errors) / len(errors)) ** 0.5 if errors else float("nan")
print(len(found), len(result["modes"]) - len(found), f"{min(macs, default=float('nan')):.4f} {rms:.2f}")
PY
}
# serve SECONDS SEED BITS: the service on a clip; "seed bits found false mac sigma" in $out/row_BITS.
serve() {
  local row folder=$out/$1_$2_$3 clip=$out/$3.mp4
  [ "$3" != lossless ] || clip=$out/drawn/clip.y4m
  quietly "$bin/hovermodald" --config "$out/drawn/config.yaml" --set "camera.source=$PWD/$clip" --set telemetry.lcm_url= --set closure.adopt=off --report "$folder"
  row=$(score "$folder") # by itself, so that a failure ends the run
  echo "$2 $3 $row" >"$out/row_$3"
  rm -f "$folder/tracks.csv"
}
# clips SECONDS SEED: the four clips of a seed, two at a time; nothing here depends on how long it takes.
clips() {
  quietly "$bin/hovermodal" simulate --scene tools/scenes/paper.yaml --duration "$1" --seed "$2" --raw --force --out "$out/drawn"
  serve "$1" "$2" lossless &
  encode
  serve "$1" "$2" "${rates[0]}"
  wait $!
  rm -f "$out/drawn/clip.y4m"
  serve "$1" "$2" "${rates[1]}" &
  serve "$1" "$2" "${rates[2]}"
  wait $!
  cat "$out"/row_* >"$kept/new"
  mv "$kept/new" "$kept/$2"
  rm -f "$out"/row_* "$out"/*.mp4
}
# runs SECONDS: a line for every clip in $out/SECONDS.tsv. Those of a seed stay for a run that was cut off; a change of what
# the figure measures begins again.
runs() {
  local seed kept
  kept=$out/$1-$(python3 tools/figures/tables.py --rooms "trust_clips_$1" | sha256sum | cut -c1-16)
  mkdir -p "$kept"
  : >"$out/$1.tsv"
  for ((seed = first_seed; seed < first_seed + seeds; ++seed)); do
    if [ ! -e "$kept/$seed" ]; then
      echo "clips of $1 s: seed $seed of $first_seed-$((first_seed + seeds - 1))" >&2
      clips "$1" "$seed"
    fi
    cat "$kept/$seed" >>"$out/$1.tsv"
  done
}
# sum SECONDS BITS: records, modes found, false ones, least MAC, rms of the errors in sigma.
sum() {
  awk -v bits="$2" '$2 == bits { n++; found += $3; wrong += $4; if (mac == "" || $5 < mac) mac = $5; if ($6 != "nan") { m++; s += $6 * $6 } }
    END { printf "%d %d %d %s %.2f\n", n, found, wrong, mac == "" ? "nan" : mac, m ? sqrt(s / m) : 0 }' "$out/$1.tsv"
}
compressed() { # SECONDS: the lines of all clips of this length.
  local s=$1 bits n found wrong mac sigma lossless
  runs "$s"
  read -r n lossless wrong mac sigma < <(sum "$s" lossless)
  line "2b.$s.lossless" beside "$lossless modes in $n, $wrong that are none, least MAC $mac, errors $sigma sigma rms" "-" "$s s, without loss"
  for bits in "${rates[@]}"; do
    read -r n found wrong mac sigma < <(sum "$s" "$bits")
    judge "2b.$s.$bits" "$found modes in $n, $lossless without loss; $wrong that are none, least MAC $mac, errors $sigma sigma rms" \
      "modes found >= those of the lossless clip less one in ten, no false one, MAC and sigma beside" "$s s of H.264 at $bits bits a pixel" \
      "$n > 0 && $found >= 0.9 * $lossless && $wrong == 0"
  done
}
figure_2b_60() { compressed 60; }
figure_2b_300() { compressed 300; }
run_figures "${figures[@]}"

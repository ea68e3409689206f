# Figures 1c and 2 of live_closure.sh on drawn clips. Sourced by it.
# shellcheck shell=bash

# clip NAME EFFECTS SEED: a drawn scene as declared until 60 s, with these effects from there on; both through the service.
clip() {
  local folder=$out/$1 half effects
  rm -rf "$folder" && mkdir -p "$folder"
  for half in before after; do
    effects=$2
    [ $half = after ] || effects=
    "$bin/hovermodal-validate" closure-clip --first-seed "$3" --duration "$clip_s" --effect "$effects" >"$folder/$half.yaml"
    quietly "$bin/hovermodal" simulate --scene "$folder/$half.yaml" --size 960x540 --out "$folder/$half" --threads "$(nproc)"
  done
  quietly ffmpeg -nostdin -y -t 60 -i "$folder/before/clip.mp4" -ss 60 -i "$folder/after/clip.mp4" \
    -filter_complex '[0:v][1:v]concat=n=2:v=1' -c:v libx264 -crf 12 -preset veryfast -pix_fmt yuv420p "$folder/clip.mp4"
  rm -f "$folder"/before/clip.mp4 "$folder"/after/clip.mp4
  quietly "$bin/hovermodal" identify --series "$folder/before/truth_displacements.csv" --base base --report "$folder/truth"
  local how=("$bin/hovermodald" --config "$folder/before/config.yaml" --set "camera.source=$folder/clip.mp4" --set telemetry.lcm_url= \
    --set tracking.points_per_region=12)
  quietly "${how[@]}" "${brief[@]}" --set "telemetry.log_file=$folder/log.lcm" --report "$folder/auto"
  quietly "${how[@]}" --set closure.adopt=off --report "$folder/off"
}
pixels() { # NAME EFFECTS SEED
  clip "$@"
  local found effect all=1
  found=$(corrections "$1/auto")
  while read -r effect; do [[ $found == *"$effect"* ]] || all=0; done <<<"${2// + /$'\n'}"
  judge "1c.$1" "in force at the end: ${found:-nothing}; modes, error and sigma $(errors_of "$1" auto) with the loop, $(errors_of "$1" off) without it" \
    "$2 taken out" "drawn clip of $clip_s s, the effect from 60 s on" "$all"
}
figure_1c_readout() { pixels readout "readout time" "$first_seed"; }
figure_1c_radial() { pixels radial "radial distortion" "$((first_seed + 1))"; }
figure_1c_radial_2() { pixels radial_2 "radial distortion" "$((first_seed + 2))"; }
figure_1c_tangential() { pixels tangential "tangential distortion" "$((first_seed + 3))"; }
figure_1c_both() { pixels both "readout time + radial distortion" "$((first_seed + 4))"; }
figure_1c() {
  local name
  for name in readout radial radial_2 tangential both; do "figure_1c_$name"; done
}
corrections() { # effects found and corrected by the run, from modal.json
  python3 -c 'import json, sys; print("; ".join(c for c in json.load(open(sys.argv[1]))["corrections"] if "from frame" in c))' "$out/$1/modal.json"
}
errors_of() { # NAME RUN: modes found of those in the truth, rms error and sigma in percent
  python3 - "$out/$1/truth/modal.json" "$out/$1/$2/modal.json" <<'PY'
import json, math, sys
truth, found = (json.load(open(p))["modes"] for p in sys.argv[1:])
pairs = []
for t in truth:
    near = [m for m in found if abs(m["frequency_hz"] / t["frequency_hz"] - 1) < 0.05]
    if near:
        pairs.append((t, min(near, key=lambda m: abs(m["frequency_hz"] - t["frequency_hz"]))))
rms = lambda v: math.sqrt(sum(x * x for x in v) / len(v)) if v else float("nan")
error = rms([100 * (m["frequency_hz"] / t["frequency_hz"] - 1) for t, m in pairs])
sigma = rms([100 * (m.get("frequency_std_hz") or 0) / t["frequency_hz"] for t, m in pairs])
print(f"{len(pairs)}/{len(truth)}, {error:.3f} +- {sigma:.3f} %")
PY
}

# --- 1c: foreign clips --------------------------------------------------------------------------------------------------------
flight=$data/phantom4_hover/flight_10hz.csv
foreign_scene() { # SEED [EFFECT]: its scene, on standard output
  "$bin/hovermodal-validate" closure-clip-foreign --first-seed "$1" --duration "$foreign_s" --flight "$flight" ${2:+--effect "$2" --strength 1}
}
# foreign_seeds N: the first seeds whose clips fly as recorded and by a drawn hover, in turns
foreign_seeds() {
  local seed=$first_seed recorded=() drawn=() i
  for (( ; ${#recorded[@]} < ($1 + 1) / 2 || ${#drawn[@]} < $1 / 2; seed++)); do
    if foreign_scene "$seed" | grep -q '^# recorded hover'; then recorded+=("$seed"); else drawn+=("$seed"); fi
  done
  for ((i = 0; i < $1; i++)); do
    if [ $((i % 2)) -eq 0 ]; then echo "${recorded[i / 2]}"; else echo "${drawn[i / 2]}"; fi
  done
}
# foreign_live NAME SEED [EFFECT FROM_S TO_S]: the clip, with the effect between these times, through the service with the loop
# and without it, and without the effect; reports in NAME/auto, NAME/off, NAME/twin. What is there already stays.
foreign_live() {
  local folder=$out/$1 scene parts how run source
  [ ! -e "$folder/done" ] || return 0
  rm -rf "$folder" && mkdir -p "$folder"
  for scene in plain ${3:+with}; do
    foreign_scene "$2" "$([ $scene = plain ] || echo "${3:-}")" >"$folder/$scene.yaml"
    quietly "$bin/hovermodal" simulate --scene "$folder/$scene.yaml" --size 640x360 --crf 6 --out "$folder/$scene" --threads "$(nproc)"
  done
  quietly "$bin/hovermodal" identify --series "$folder/plain/truth_displacements.csv" --base base --report "$folder/truth"
  if [ -n "${3:-}" ]; then
    parts="[0:v]trim=0:$4,setpts=PTS-STARTPTS[a];[1:v]trim=$4:$5,setpts=PTS-STARTPTS[b];[0:v]trim=$5,setpts=PTS-STARTPTS[c];[a][b][c]concat=n=3:v=1"
    [ "$4" != 0 ] || parts="[1:v]trim=0:$5,setpts=PTS-STARTPTS[b];[0:v]trim=$5,setpts=PTS-STARTPTS[c];[b][c]concat=n=2:v=1"
    [ "$5" != end ] || parts="[0:v]trim=0:$4,setpts=PTS-STARTPTS[a];[1:v]trim=$4,setpts=PTS-STARTPTS[b];[a][b]concat=n=2:v=1"
    [ "$4 $5" != "0 end" ] || parts="[1:v]null"
    quietly ffmpeg -nostdin -y -i "$folder/plain/clip.mp4" -i "$folder/with/clip.mp4" -filter_complex "$parts" \
      -c:v libx264 -crf 6 -preset veryfast -pix_fmt yuvj420p -fps_mode passthrough "$folder/clip.mp4"
  fi
  how=("$bin/hovermodald" --config "$folder/plain/config.yaml" --set telemetry.lcm_url= --set tracking.points_per_region=12 "${brief[@]}")
  for run in auto off ${3:+twin}; do
    source=$folder/plain/clip.mp4
    [ -z "${3:-}" ] || [ $run = twin ] || source=$folder/clip.mp4
    quietly "${how[@]}" --set "camera.source=$source" --set "closure.adopt=$([ $run = auto ] && echo auto || echo off)" \
      --set "telemetry.log_file=$([ $run = auto ] && echo "$folder/log.lcm" || true)" --report "$folder/$run"
    rm -f "$folder/$run"/tracks.csv "$folder/$run"/displacements.csv
  done
  rm -f "$folder"/*/clip.mp4 "$folder/clip.mp4" "$folder"/*/truth_displacements.csv
  touch "$folder/done"
}
# foreign_verdict NAME EFFECT: taken out and nothing else (1 or 0), in force at the end, and changes, as reported over LCM
foreign_verdict() {
  python3 -B tools/figures/lcm_log.py changes "$out/$1/log.lcm" build/release/python | python3 -c '
import sys
effect, changes = sys.argv[1], [row.rstrip("\n") for row in sys.stdin]
mine = [c for c in changes if effect and effect in c]
others = [c for c in changes if c not in mine and not c.startswith("the run is measured again")]
taken = any("taken out" in c for c in mine)
print(int(taken and not others if effect else not others), int(any("withdrawn" in c for c in mine)), "; ".join(mine + others) or "nothing", sep="\t")' "$2"
}
figure_1c_clips() {
  local bar="Every effect that can be corrected, onset at 0, 60 s, in mid-flight, going away at 300 s; 10 rendered clips (half on the recorded hover): "
  local effects=("readout time" "radial distortion" "tangential distortion") from=(0 60 210 0) to=(end end end 300) seeds i name effect
  [ -f "$flight" ] || { line 1c.clips SKIP "no $flight" "$bar" "rendered clips"; return; }
  mapfile -t seeds < <(foreign_seeds "$foreign_clips")
  quietly tools/build.sh hovermodal_python_messages
  : >"$out/foreign.txt"
  for ((i = 0; i < foreign_clips; i++)); do
    name=$(kept_name foreign)_$i effect=${effects[i % 3]}
    foreign_live "$name" "${seeds[i]}" "$effect" "${from[i % 4]}" "${to[i % 4]}"
    printf '%s\t%s\t%s\t%s\t%s\t%s\t%s\t%s\n' "${seeds[i]}" "$effect" "${from[i % 4]} ${to[i % 4]}" "$(foreign_verdict "$name" "$effect")" \
      "$(errors_of "$name" auto)" "$(errors_of "$name" off)" "$(errors_of "$name" twin)" "$(grep -c '^# recorded' "$out/$name/plain.yaml" || true)" >>"$out/foreign.txt"
  done
  local words verdict measured
  while IFS=$'\t' read -r name verdict measured words; do
    if [ "$verdict" = beside ]; then line "1c.$name" beside "$measured" "-" "drawn clip of $foreign_s s"; continue; fi
    judge "1c.$name" "$measured" "$bar$words" "drawn clips of $foreign_s s" "$verdict"
  done < <(foreign_cells)
}
foreign_cells() { # a line of each clip, then the figures
  python3 - "$out/foreign.txt" <<'PY'
import statistics, sys
rows = [r.rstrip("\n").split("\t") for r in open(sys.argv[1], encoding="utf-8")]
def put(*words):
    print(*words, sep="\t")
def modes(r, i):
    return int(r[i].split("/")[0])
def numbers(r, i):  # "5/6, 0.100 +- 0.200 %"
    error, sigma = r[i].split(", ")[1].rstrip(" %").split(" +- ")
    return float(error), float(sigma)
for r in rows:
    put("clip", "beside", f"seed {r[0]}{' (recorded hover)' if r[9] == '1' else ''}, {r[1]} from {r[2].replace(' ', ' to ')}: {r[5]}; {r[6]} with the loop, {r[7]} without it, {r[8]} without the effect")
good = sum(r[3] == "1" for r in rows)
put("taken", int(good >= 0.95 * len(rows) > 0), f"{good} of {len(rows)}", "taken out and nothing else in 95 %")
ended = [r for r in rows if not r[2].endswith("end")]
good = sum(r[4] == "1" for r in ended)
put("withdrawn", int(good >= 0.95 * len(ended) > 0), f"{good} of {len(ended)}", "withdrawn in 95 %")
fewer = [r for r in rows if modes(r, 6) < modes(r, 7)]
put("modes", int(len(fewer) <= 0.02 * len(rows)), f"fewer in {len(fewer)} of {len(rows)}", "modes with the loop >= without, in every record but 2 %")
for name, against, factor, words in (("error", 7, 1.0, "error and sigma <= those without, in the median of every effect"),
                                     ("twin", 8, 1.1, "within 1.1 times those of the record without the effect")):
    bad = []
    for effect in dict.fromkeys(r[1] for r in rows):
        group = [r for r in rows if r[1] == effect]
        for k, what in enumerate(("error", "sigma")):
            ours, theirs = (statistics.median(numbers(r, i)[k] for r in group) for i in (6, against))
            if not ours <= factor * theirs:
                bad.append(f"{what} of {effect} {ours:.3f} for {theirs:.3f} %")
    put(name, int(not bad), "; ".join(bad) or "in every effect", words)
PY
}

# --- 2c: clean clips -----------------------------------------------------------------------------------------------------------
figure_2c() {
  local bar="100 clean records with hover tails and 20 clean clips: 0 change anything" i seed changed=0 listed= named words
  [ -f "$flight" ] || { line 2c SKIP "no $flight" "$bar" "clean clips"; return; }
  quietly tools/build.sh hovermodal_python_messages
  for ((i = 0; i < clean_clips; i++)); do
    seed=$((first_seed + 100 + i))
    foreign_live "$(kept_name clean)_$i" "$seed"
    IFS=$'\t' read -r named _ words < <(foreign_verdict "$(kept_name clean)_$i" "")
    echo "# seed $seed: $words; modes $(errors_of "$(kept_name clean)_$i" auto) with the loop, $(errors_of "$(kept_name clean)_$i" off) without it"
    [ "$named" -eq 1 ] || { changed=$((changed + 1)) listed+=" $seed: $words;"; }
  done
  judge 2c "$changed of $clean_clips:${listed:- nothing}" "$bar" "drawn clips of $foreign_s s without an effect, one in four on the recorded hover" "$changed == 0"
}
# Folders of what stays for a run that was cut off: named after the content of what they measure.
kept_name() { echo "$1-$(python3 tools/figures/tables.py --rooms live_closure_1c | sha256sum | cut -c1-12)"; }

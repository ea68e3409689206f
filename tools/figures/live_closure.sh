#!/usr/bin/env bash
# The loop closed in flight (closure.adopt: auto): effects that begin in mid-flight, records without one, replays, and
# what it costs. One line a figure. About an hour on two processors; --quick takes a fifth of the seeds: 15 minutes.
#   tools/figures/live_closure.sh [--quick] [FIGURE...]      FIGURE: some of 1, 1c (the clips), 2 ... 5 (default: all)
# Figure 4 measures time: leave the machine alone meanwhile. SKIP where measured data (HOVERMODAL_DATA) are absent.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
seeds=5 nulls=100 clip_s=300 latency_s=60
[ "${1:-}" != --quick ] || { seeds=1 nulls=20 clip_s=240 latency_s=25 && shift; }
figures=("${@:-}")
[ -n "${figures[0]}" ] || figures=(1 1c 2 3 4 5)
out=$PWD/build/figures/live_closure
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh hovermodal hovermodald overload_run
brief=(--set closure.adopt=auto --set closure.window_s=60 --set closure.period_s=30 --set closure.delay_s=15)

# --- 1: effects that begin in mid-flight ------------------------------------------------------------------------------
figure_1() {
  "$bin/hovermodal" selftest closure-live --seeds "$seeds" --threads "$(nproc)" >"$out/tracks.txt"
  local name n alone after with with_error without without_error twin twin_error total=0 right=0
  while IFS=$'\t' read -r name n alone after with with_error without without_error twin twin_error; do
    line "1.${name// /_}" beside "taken out and nothing else in $alone of $n, $after s after the onset; modes found $with with the loop, $without without it, $twin without the effect; error and sigma $with_error, $without_error, $twin_error % rms" \
      "-" "tracks, effect of strength 1 from 90 s of 480 s on"
    total=$((total + n)) right=$((right + alone))
  done < <(tracks_cells)
  judge 1 "$right of $total" "95 %" "track records whose effects are all taken out, and nothing else" "$right >= 0.95 * $total"
}
tracks_cells() { # a line per case, from the records' lines
  python3 - "$out/tracks.txt" <<'PY'
import collections, math, statistics, sys
cells = collections.OrderedDict()
for row in open(sys.argv[1]):
    f = row.rstrip("\n").split("\t")
    if f[0] == "closure-live":
        cells.setdefault(f[1], []).append(f)
for name, rows in cells.items():
    alone = [r for r in rows if not math.isnan(float(r[3])) and r[4] == "0"]
    times = [float(r[3]) for r in rows if not math.isnan(float(r[3]))]
    found = [f"{sum(int(r[i].split('/')[0]) for r in rows)}/{sum(int(r[i].split('/')[1]) for r in rows)}" for i in (6, 9, 12)]
    def middle(i):
        return f"{statistics.median(float(r[i]) for r in rows):.3f}"
    errors = [f"{middle(i)} +- {middle(i + 1)}" for i in (7, 10, 13)]
    print(name, len(rows), len(alone), f"{statistics.median(times):.0f}" if times else "-",
          *(word for pair in zip(found, errors) for word in pair), sep="\t")
PY
}
# clip NAME EFFECT SCENE: drawn as declared until 60 s, with the scene's effect from there on; both through the service.
clip() {
  local folder=$out/$1 scene=$3
  rm -rf "$folder" && mkdir -p "$folder"
  local half
  for half in before after; do
    printf 'preset: paper\nduration_s: %s\nseed: %s\ndeclare: {lens: false, readout_ms: false}\n' "$clip_s" "$number" >"$folder/$half.yaml"
    [ $half = before ] || printf '%s\n' "$scene" >>"$folder/$half.yaml"
    quietly "$bin/hovermodal" simulate --scene "$folder/$half.yaml" --size 640x360 --out "$folder/$half" --threads "$(nproc)"
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
figure_1c() {
  local number=0
  while IFS='|' read -r name effect scene; do
    number=$((number + 1))
    clip "$name" "$effect" "$scene"
    local found with without
    found=$(corrections "$name/auto")
    with=$(errors_of "$name" auto) without=$(errors_of "$name" off)
    judge "1c.$name" "in force at the end: ${found:-nothing}; modes, error and sigma $with with the loop, $without without it" "$effect taken out" \
      "rendered clip of $clip_s s, the effect from 60 s on" "$([[ $found == *"$effect"* ]] && echo 1 || echo 0)"
  done <<'CASES'
readout|readout time|camera: {readout_ms: 30}
barrel|radial distortion|camera: {lens: {model: radial_tangential, k: [-0.2, 0, 0, 0, 0]}}
cushion|radial distortion|camera: {lens: {model: radial_tangential, k: [0.15, 0, 0, 0, 0]}}
decentred|tangential distortion|camera: {lens: {model: radial_tangential, k: [0, 0, 0.02, -0.01, 0]}}
both|readout time|camera: {readout_ms: 25, lens: {model: radial_tangential, k: [-0.2, 0, 0, 0, 0]}}
CASES
}
corrections() { # what the run found and took out, from modal.json
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

# --- 2: nothing to find -----------------------------------------------------------------------------------------------
figure_2() {
  "$bin/hovermodal" selftest closure-live-null --seeds "$nulls" --threads "$(nproc)" >"$out/null.txt"
  local changed worst
  read -r changed worst < <(awk -F'\t' '$1 == "closure-live-null" { if ($3 > 0) c++; if ($4 > w) w = $4 } END { print c + 0, w + 0 }' "$out/null.txt")
  judge 2 "$changed of $nulls adopt something; frequencies within $worst sigma of those with the loop off" "1 of 100, 0.05 sigma" \
    "clean track records of 300 s, shaken and wind-driven" "$changed <= 0.01 * $nulls && $worst <= 0.05"
}

# --- 3: again ---------------------------------------------------------------------------------------------------------
figure_3() {
  local number=2 folder=$out/barrel same=0 n=0 file
  [ -s "$folder/auto/modal.json" ] && [ -s "$folder/clip.mp4" ] || clip barrel "radial distortion" "camera: {lens: {model: radial_tangential, k: [-0.2, 0, 0, 0, 0]}}"
  quietly "$bin/hovermodald" --config "$folder/before/config.yaml" --set "camera.source=$folder/clip.mp4" --set telemetry.lcm_url= \
    --set tracking.points_per_region=12 "${brief[@]}" --set rt.frame_slots=4 --set rt.sample_slots=16 --report "$folder/again"
  for file in tracks.csv displacements.csv modal.json closure.json; do
    n=$((n + 1))
    ! cmp -s "$folder/auto/$file" "$folder/again/$file" || same=$((same + 1))
  done
  judge 3 "$same of $n files of the report are the same bytes; $(corrections barrel/auto)" "all" \
    "the same clip through the service twice, with other ring sizes" "$same == $n"
  local again=0
  for run in 1 2; do
    "$bin/hovermodal" replay --tracks "$folder/auto/tracks.csv" --config "$folder/before/config.yaml" --set tracking.points_per_region=12 "${brief[@]}" \
      --set telemetry.lcm_url= --report "$folder/replay_$run" >"$folder/replay_$run.txt"
  done
  ! cmp -s "$folder/replay_1/modal.json" "$folder/replay_2/modal.json" || again=1
  local of_run of_replay
  of_run=$(corrections barrel/auto | grep -o 'from frame [0-9]*' | tr '\n' ' ') of_replay=$(corrections barrel/replay_1 | grep -o 'from frame [0-9]*' | tr '\n' ' ')
  judge 3r "${of_replay:-never} (the run: ${of_run:-never}); twice the same bytes: $([ $again = 1 ] && echo yes || echo no)" "the run's frames, the same bytes" \
    "replay of the run's tracks.csv" "$again == 1 && \"$of_run\" == \"$of_replay\" && \"$of_run\" != \"\""
}

# --- 4: what it costs the frames --------------------------------------------------------------------------------------
figure_4() {
  local repeat adopt
  for repeat in 1 2 3; do
    for adopt in off auto; do
      "$bin/overload_run" latency "$latency_s" 1 80 closure.adopt=$adopt closure.window_s=20 closure.period_s=20 closure.delay_s=10 \
        >"$out/latency_${adopt}_$repeat.txt" 2>/dev/null || true
    done
  done
  python3 - "$out" >"$out/latency.txt" <<'PY'
import sys
out = sys.argv[1]
def read(adopt, name):
    values = []
    for repeat in (1, 2, 3):
        for row in open(f"{out}/latency_{adopt}_{repeat}.txt"):
            f = row.split("\t")
            if f[0] == name:
                values.append(float(f[1].split()[0]))
    return sorted(values)
for name in ("p50", "p99", "p99.9"):
    off, on = read("off", name), read("auto", name)
    scatter = max(off[-1] - off[0], on[-1] - on[0], 0.1)
    print(name, off[1], on[1], f"{scatter:.1f}", int(abs(on[1] - off[1]) <= scatter), sep="\t")
PY
  local name off on scatter within
  while IFS=$'\t' read -r name off on scatter within; do
    judge "4.$name" "$off -> $on ms, medians of three; they scatter by $scatter ms" "no more than the scatter" \
      "frame to displacement, 1920 x 1080 at 60 frames a second under load, closure off and auto" "$within == 1"
  done <"$out/latency.txt"
}

# --- 5: measured clips, wrongly declared ------------------------------------------------------------------------------
told() { # NAME: what the operator was told, report by report
  "$bin/hovermodal" spy --url "file://$out/$1.lcm?speed=0" --plain --once 2>/dev/null | sed -n '/^LOOP/,/^[A-Z]/p' | grep -v '^[A-KM-Z]' | sed 's/^ *//' | tr '\n' ';' | cut -c1-400
}
figure_5() {
  local bar="told, no crash; modes printed" what
  for what in phone_rolling_shutter_gyro knex_frame_video; do
    [ -d "$data/$what" ] || { line 5 SKIP "-" "$bar" "no $data/$what"; return; }
  done
  cat >"$out/phone.yaml" <<Y
camera: {driver: file, source: "$data/phone_rolling_shutter_gyro/frames", rate_hz: 30}
calibration: {fx: 574.4, fy: 574.4, cx: 359.5, cy: 239.5}
regions:
  - {name: left, rect: [20, 60, 200, 300]}
  - {name: middle, rect: [260, 60, 200, 300]}
  - {name: right, rect: [500, 60, 200, 300]}
spectrum: {segment: 64}
scale: {adaptive: false}
Y
  knex_config >"$out/knex.yaml"
  local name
  for name in phone knex; do
    rm -f "$out/$name.lcm"
    if "$bin/hovermodald" --config "$out/$name.yaml" --set telemetry.lcm_url= --set "telemetry.log_file=$out/$name.lcm" --set closure.adopt=auto \
      --set closure.window_s=20 --set closure.period_s=20 --set closure.delay_s=0 --report "$out/$name" >"$out/$name.txt" 2>&1; then
      judge "5.$name" "$(told "$name")" "$bar" "measured clip through the service with the loop closed" "$([ -n "$(told "$name")" ] && echo 1 || echo 0)"
    else
      judge "5.$name" "$(tail -n 1 "$out/$name.txt")" "$bar" "measured clip through the service with the loop closed" 0
    fi
  done
}

run_figures "${figures[@]}"

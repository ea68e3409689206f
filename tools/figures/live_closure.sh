#!/usr/bin/env bash
# The loop closed in flight (closure.adopt: auto): effects that are there from the start, begin in mid-flight or go away,
# records without one, replays, and what it costs. One line a figure. About five hours on two processors; --quick takes a fifth of the seeds.
#   tools/figures/live_closure.sh [--quick] [--seeds N] [--first-seed N] [FIGURE...]
# FIGURE: some of 1, 1m (one or two effects from mid-flight on), 1c (five clips; one alone: 1c_readout 1c_radial 1c_radial_2
# 1c_tangential 1c_both), 1c_clips (ten foreign clips), 2, 2c (clean clips), 2f (as asked formerly), 3, 4 (latency), 4f (as asked
# formerly), 4s (seconds to the swap), 4m (memory), 5, 5p (the ground page, needs multicast and chromium) (default: all). Seeds begin with --first-seed (1001: those that nobody looked at while the loop was made).
# Figure 4 measures time: leave the machine alone meanwhile. SKIP where measured data (HOVERMODAL_DATA) are absent.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/live_closure.sh [--quick] [--seeds N] [--first-seed N] [FIGURE...]" "$@"
seeds=20 onset_seeds=5 nulls=100 clip_s=300 latency_s=60 foreign_clips=10 clean_clips=20 foreign_s=420
[ -z "$quick" ] || seeds=4 onset_seeds=1 nulls=20 clip_s=240 latency_s=25 foreign_clips=4 clean_clips=4
[ -z "$n_seeds" ] || seeds=$n_seeds onset_seeds=$n_seeds nulls=$n_seeds
[ ${#figures[@]} -gt 0 ] || figures=(1 1m 1c 1c_clips 2 2c 2f 3 4 4f 4s 4m 5 5p)
out=$PWD/build/figures/live_closure
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh hovermodal hovermodald overload_run hovermodal-validate
brief=(--set closure.adopt=auto --set closure.window_s=60 --set closure.period_s=30 --set closure.delay_s=15)

# --- 1: effects that can be corrected ---------------------------------------------------------------------------------
figure_1() {
  local effect bar what
  # The records of every two seeds are kept: a run that was cut off goes on, a change of what is measured begins anew.
  local kept first last
  kept=$out/tracks-$(python3 tools/figures/tables.py --rooms live_closure_1 | sha256sum | cut -c1-16)
  mkdir -p "$kept"
  : >"$out/tracks.txt"
  for effect in "readout time" "radial distortion" "tangential distortion" "pixel locking"; do
    for ((first = first_seed; first < first_seed + seeds; first += 2)); do
      last=$((first + 1 < first_seed + seeds ? first + 1 : first_seed + seeds - 1))
      what=$kept/${effect// /_}-$first-$last
      if [ ! -e "$what" ]; then
        echo "closure-live: $effect, seeds $first-$last" >&2
        "$bin/hovermodal-validate" closure-live --effect "$effect" --first-seed "$first" --seeds "$((last - first + 1))" --threads "$(nproc)" >"$kept/new"
        mv "$kept/new" "$what"
      fi
      cat "$what" >>"$out/tracks.txt"
    done
  done
  bar="Every effect that can be corrected, onset at 0, 60 s, in mid-flight, going away at 300 s; 20 records of tracks each and 10 rendered clips (half on the recorded hover): "
  local name words verdict measured
  while IFS=$'\t' read -r name verdict measured words; do
    what="tracks, effects of strength 1, 480 s"
    if [ "$verdict" = beside ]; then line "1.$name" beside "$measured" "-" "$what"; continue; fi
    judge "1.$name" "$measured" "$bar$words" "$what" "$verdict"
  done < <(live_cells)
}
figure_1m() {
  "$bin/hovermodal-validate" closure-live --first-seed "$first_seed" --seeds "$onset_seeds" --threads "$(nproc)" >"$out/onset.txt"
  local name n alone after with with_error without without_error twin twin_error total=0 right=0
  while IFS=$'\t' read -r name n alone after with with_error without without_error twin twin_error; do
    line "1m.${name// /_}" beside "taken out and nothing else in $alone of $n, $after s after the onset; modes found $with with the loop, $without without it, $twin without the effect; error and sigma $with_error, $without_error, $twin_error % rms" \
      "-" "tracks, effect of strength 1 from 90 s of 480 s on"
    total=$((total + n)) right=$((right + alone))
  done < <(onset_cells)
  judge 1m "$right of $total" "one or two effects from mid-flight on: all taken out, nothing else, in 0.95" "track records, effects of strength 1" "$right >= 0.95 * $total"
}
onset_cells() { # a line per case, from the lines of the records
  cells "$out/onset.txt" closure-live 1 <<'PY'
alone = [r for r in rows if not math.isnan(float(r[4])) and r[6] == "0"]
found = [f"{sum(int(r[i].split('/')[0]) for r in rows)}/{sum(int(r[i].split('/')[1]) for r in rows)}" for i in (8, 11, 14)]
def median(i):
    return f"{statistics.median(float(r[i]) for r in rows):.3f}"
errors = [f"{median(i)} +- {median(i + 1)}" for i in (9, 12, 15)]
put(*key, len(rows), len(alone), f"{middle(4):.0f}" if column(4) else "-", *(word for pair in zip(found, errors) for word in pair))
PY
}
live_cells() { # a line of each effect and presence, then the figures
  python3 - "$out/tracks.txt" <<'PY'
import math, statistics, sys
rows = [r.rstrip("\n").split("\t") for r in open(sys.argv[1], encoding="utf-8") if r.startswith("closure-live\t")]
def number(row, i):
    return float(row[i])
def found(row, i):
    return int(row[i].split("/")[0])
def taken(row):
    return not math.isnan(number(row, 4)) and row[6] == "0"
def median(group, i):
    values = [number(r, i) for r in group if not math.isnan(number(r, i))]
    return statistics.median(values) if values else float("nan")
def put(*words):
    print(*words, sep="\t")
def modes(group, i):
    return f"{sum(found(r, i) for r in group)}/{sum(int(r[i].split('/')[1]) for r in group)}"
for key in dict.fromkeys((r[1], r[2]) for r in rows):
    group = [r for r in rows if (r[1], r[2]) == key]
    errors = [f"{modes(group, i)} modes, {median(group, i + 1):.3f} +- {median(group, i + 2):.3f} %" for i in (8, 11, 14)]
    put("_".join(key).replace(" ", "_"), "beside",
        f"taken out and nothing else in {sum(map(taken, group))} of {len(group)}, {median(group, 4):.0f} s after the onset; "
        f"{errors[0]} with the loop, {errors[1]} without it, {errors[2]} without the effect")
good = sum(map(taken, rows))
put("taken", int(good >= 0.95 * len(rows) > 0), f"{good} of {len(rows)}", "taken out and nothing else in 95 %")
ended = [r for r in rows if r[2].startswith("until")]
good = sum(not math.isnan(number(r, 5)) for r in ended)
put("withdrawn", int(good >= 0.95 * len(ended) > 0), f"{good} of {len(ended)}", "withdrawn in 95 %")
fewer = [r for r in rows if found(r, 8) < found(r, 11)]
put("modes", int(len(fewer) <= 0.02 * len(rows)), f"fewer in {len(fewer)} of {len(rows)}: {modes(rows, 8)} with the loop, {modes(rows, 11)} without it",
    "modes with the loop >= without, in every record but 2 %")
def worse(i, against, factor):
    out = []
    for effect in dict.fromkeys(r[1] for r in rows):
        group = [r for r in rows if r[1] == effect]
        if not median(group, i) <= factor * median(group, against):
            out.append(f"{effect} {median(group, i):.3f} for {median(group, against):.3f} %")
    return out
bad = [f"error of {w}" for w in worse(9, 12, 1.0)] + [f"sigma of {w}" for w in worse(10, 13, 1.0)]
put("error", int(not bad), "; ".join(bad) or "in every effect", "error and sigma <= those without, in the median of every effect")
bad = [f"error of {w}" for w in worse(9, 15, 1.1)] + [f"sigma of {w}" for w in worse(10, 16, 1.1)]
put("twin", int(not bad), "; ".join(bad) or "in every effect", "within 1.1 times those of the record without the effect")
PY
}
. tools/figures/live_closure_clips.sh

# --- 2: nothing to find -----------------------------------------------------------------------------------------------
figure_2() {
  local bar="100 clean records with hover tails and 20 clean clips: 0 change anything" changed hovers
  [ -f "$flight" ] || { line 2 SKIP "no $flight" "$bar" "clean records"; return; }
  kept_null "$(kept_name null)" --flight "$flight"
  changed=$(awk -F'\t' '$1 == "closure-live-null" && $3 > 0 { n++ } END { print n + 0 }' "$out/null.txt")
  hovers=$(awk -F'\t' '$1 == "closure-live-null" { n[$6]++ } END { for (h in n) printf "%s%d %s", (k++ ? ", " : ""), n[h], h }' "$out/null.txt")
  judge 2 "$changed of $nulls:$(awk -F'\t' '$1 == "closure-live-null" && $3 > 0 { printf " %s %s;", $2, $5 }' "$out/null.txt")" "$bar" \
    "clean track records of 300 s, shaken and wind-driven; hover $hovers" "$changed == 0"
}
figure_2f() { # as asked formerly
  local changed worst
  kept_null "$(kept_name null_former)"
  read -r changed worst < <(awk -F'\t' '$1 == "closure-live-null" { if ($3 > 0) c++; if ($4 > w) w = $4 } END { print c + 0, w + 0 }' "$out/null.txt")
  judge 2f "$changed of $nulls adopt something; frequencies and damping within $worst sigma of those with the loop off" "at most 1 adoption of 100; modal results within 0.05 sigma" \
    "clean track records of 300 s, shaken and wind-driven, hover as the model's" "$changed <= 0.01 * $nulls && $worst <= 0.05"
}
kept_null() { # NAME [OPTION...]: the records of every ten seeds stay for a run that was cut off; all of them in null.txt
  local name=$out/$1 first last
  shift
  mkdir -p "$name"
  : >"$out/null.txt"
  for ((first = first_seed; first < first_seed + nulls; first += 10)); do
    last=$((first + 9 < first_seed + nulls ? first + 9 : first_seed + nulls - 1))
    if [ ! -e "$name/$first-$last" ]; then
      "$bin/hovermodal-validate" closure-live-null --first-seed "$first" --seeds "$((last - first + 1))" --threads "$(nproc)" "$@" >"$name/new"
      mv "$name/new" "$name/$first-$last"
    fi
    cat "$name/$first-$last" >>"$out/null.txt"
  done
}

# --- 3: again ---------------------------------------------------------------------------------------------------------
figure_3() {
  local folder=$out/radial same=0 again=0 n=0 file record of_run of_replay
  [ -s "$folder/auto/modal.json" ] && [ -s "$folder/clip.mp4" ] || clip radial "radial distortion" "$((first_seed + 1))"
  rm -rf "$folder/record"
  quietly "$bin/hovermodald" --config "$folder/before/config.yaml" --set "camera.source=$folder/clip.mp4" --set telemetry.lcm_url= \
    --set tracking.points_per_region=12 "${brief[@]}" --set rt.frame_slots=4 --set rt.sample_slots=16 --set "record.directory=$folder/record" --report "$folder/again"
  record=$(find "$folder/record" -name '*_000.lcm' | head -n 1)
  "$bin/hovermodal" replay "$record" --report "$folder/replay" >"$folder/replay.txt"
  for file in tracks.csv displacements.csv modal.json closure.json; do
    n=$((n + 1))
    ! cmp -s "$folder/auto/$file" "$folder/again/$file" || same=$((same + 1))
    ! cmp -s "$folder/again/$file" "$folder/replay/$file" || again=$((again + 1))
  done
  judge 3 "$same of $n files of the report are the same bytes; $(corrections radial/auto)" "the same bits" \
    "the same clip through the service twice, with other ring sizes" "$same == $n"
  of_run=$(frames_of again) of_replay=$(frames_of replay)
  judge 3r "adopts at ${of_replay:-never} (the run: ${of_run:-never}); $again of $n files are the run's bytes" \
    "replay of a recorded run adopts at the same frame and gives the same bits" "replay of the run's record" \
    "$again == $n && \"$of_run\" == \"$of_replay\" && \"$of_run\" != \"\""
}
frames_of() { corrections "radial/$1" | grep -o 'from frame [0-9]*' | tr '\n' ' ' || true; }

. tools/figures/live_closure_cost.sh

# --- 5: measured clips, wrongly declared ------------------------------------------------------------------------------
reported() { # NAME: the messages to the operator, report by report
  "$bin/hovermodal" spy --url "file://$out/$1.lcm?speed=0" --plain --once 2>/dev/null | sed -n '/^LOOP/,/^[A-Z]/p' | grep -v '^[A-KM-Z]' | sed 's/^ *//' | tr '\n' ';' | cut -c1-400
}
figure_5() {
  local bar="what the operator is told, when, and what changes: printed" what
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
  local name ended
  for name in phone knex; do
    rm -f "$out/$name.lcm"
    local how=("$bin/hovermodald" --config "$out/$name.yaml" --set telemetry.lcm_url= --set closure.window_s=20 --set closure.period_s=20 --set closure.delay_s=0)
    ended=1
    "${how[@]}" --set closure.adopt=auto --set "telemetry.log_file=$out/$name.lcm" --report "$out/$name" >"$out/$name.txt" 2>&1 || ended=0
    "${how[@]}" --set closure.adopt=off --report "$out/${name}_off" >"$out/${name}_off.txt" 2>&1 || ended=0
    judge "5.$name" "$(reported "$name") corrected: $(corrections "$name" || echo unknown); modes $(modes_of "${name}_off") Hz -> $(modes_of "$name") Hz" "$bar" \
      "measured clip, wrongly declared, through the service with the loop closed" "$ended && $([ -n "$(reported "$name")" ] && echo 1 || echo 0)"
  done
}
modes_of() { python3 -c 'import json, sys; print(" ".join("%.2f" % m["frequency_hz"] for m in json.load(open(sys.argv[1]))["modes"]) or "no")' "$out/$1/modal.json" || echo unknown; }

# --- 5p: the ground page, loaded again and again -----------------------------------------------------------------------
figure_5p() {
  local bar="The page: 20 reloads in Chromium during a live run: no sample lost or doubled" what="displacements that each load shows, against those that the service sent"
  local url="udpm://239.255.76.71:7671?ttl=0" clip=$out/page_clip
  ip route get 239.255.76.71 >/dev/null 2>&1 || { line 5p SKIP "no multicast route (ip route add 224.0.0.0/4 dev lo, as root)" "$bar" "$what"; return; }
  quietly tools/setup.sh --ground
  quietly tools/build.sh hovermodal_python_messages
  [ -e "$clip/config.yaml" ] || quietly "$bin/hovermodal" simulate --preset paper --duration 180 --seed "$first_seed" --size 640x360 --out "$clip" --threads "$(nproc)"
  python3 -B tests/ground/page_reloads.py "$bin" "$clip" "$out" "$url" 20 "$first_seed" >"$out/page.txt" 2>"$out/page.err" ||
    { line 5p MISS "the check ended early: $(tail -n 1 "$out/page.err")" "$bar" "$what"; return; }
  v() { awk -F'\t' -v name="$1" '$1 == name { print $2 }' "$out/page.txt"; }
  judge 5p "$(v lost) lost, $(v doubled) doubled, $(v foreign) that were not sent; $(v reloads) reloads, $(v least_shown) samples or more each" "$bar" "$what" \
    "$(v reloads) == 20 && $(v lost) == 0 && $(v doubled) == 0 && $(v foreign) == 0"
}

run_figures "${figures[@]}"

#!/usr/bin/env bash
# The figures of the main job: frames to modes over LCM, on simulated and on filmed video. One line a figure.
#   tools/figures/main_job.sh [--quick]      --quick leaves out the rendered 30 s clip and takes 3 seeds for 10
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
seeds=10 quick=no
[ "${1:-}" != --quick ] || { seeds=3 quick=yes; }
out=build/figures/main_job
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh hovermodald hovermodal

# errors_of TABLE: "|error %| MAC" of modes 1-3, "1000 0" for one that was not found.
errors_of() {
  awk '$1 ~ /^[123]$/ { if (NF < 9) print 1000, 0; else { e = $4 < 0 ? -$4 : $4; print e, $5 / 100 } }' "$1"
}

# summary TABLE...: median and worst error and MAC over modes 1-3 of all tables, "med worst med worst found".
summary() {
  local all
  all=$(for table in "$@"; do errors_of "$table"; done)
  echo "$(echo "$all" | awk '$1 < 1000 { print $1 }' | median_and_worst)" \
    "$(echo "$all" | awk '$1 < 1000 { print -$2 }' | median_and_worst | awk '{ print -$1, -$2 }')" \
    "$(echo "$all" | awk '$1 < 1000' | wc -l)"
}

in_words() {  # SUMMARY WANTED
  echo "$1 $2" | awk '{ printf "%d of %d modes, error median %.3f worst %.3f %%, MAC median %.5f worst %.5f", $5, $6, $1, $2, $3, $4 }'
}

# judge_modes NUMBER WHAT TABLE...: against the paper's own result; its chain on the same tracks stands beside (PAPER).
judge_modes() {
  local number=$1 what=$2 ours paper wanted
  shift 2
  wanted=$((3 * $#))
  ours=$(summary "$@")
  paper=$(summary "${@/%.txt/_paper.txt}")
  local words=($ours)
  judge "$number" "$(in_words "$ours" $wanted)" "modes 1-3 found, error <= 1.04 %, MAC >= 0.9967" \
    "$what; beside: the paper's chain $(in_words "$paper" $wanted)" \
    "${words[4]} == $wanted && ${words[1]} <= 1.04 && ${words[3]} >= 0.9967"
}

# truth_of TABLE...: error against the true parameters in units of sqrt(zeta / (2 pi f T)); no bar, beside.
truth_of() {
  for table in "$@"; do awk '$1 ~ /^[123]$/ && NF >= 9 { e = $8 < 0 ? -$8 : $8; s = $9 < 0 ? -$9 : $9; print e, s }' "$table"; done |
    awk '{ e2 += $2 * $2; if ($1 > w) w = $1; if ($2 > ws) ws = $2 } END { printf "against the true parameters: worst %.2f %%, rms %.2f and worst %.2f of the least possible scatter", w, sqrt(e2 / NR), ws }'
}

compare_to_truth() {  # RESULT FOLDER TABLE
  "$bin/hovermodal" compare --result "$1" --reference "$2/true_motion/modal.json" --truth "$2/truth.json" >"$3"
}

# --- 1: the demo's clips, and tracks of many seeds -------------------------------------------------------------------
clip_figure() {  # NUMBER SECONDS FOLDER
  quietly tools/demo.sh --seconds "$2" --seed 1 --out "$3" || { line "$1" MISS "the demo failed" "-" "$2 s clip"; return; }
  compare_to_truth "$3/modal.json" "$3" "$3/table.txt"
  local segment=512
  [ "$2" -ge 45 ] || segment=256
  quietly "$bin/hovermodal" replay --tracks "$3/tracks.csv" --config "$3/config.yaml" --set method=paper \
    --set spectrum.segment=$segment --report "$3/paper"
  compare_to_truth "$3/paper/modal.json" "$3" "$3/table_paper.txt"
  judge_modes "$1" "$2 s of rendered 1080p25; $(truth_of "$3/table.txt")" "$3/table.txt"
}

track_figure() {  # NUMBER SECONDS SEGMENT
  local tables=()
  for seed in $(seq 1 "$seeds"); do
    local folder=$out/tracks_$2_$seed
    quietly "$bin/hovermodal" simulate --preset paper --tracks-only --duration "$2" --seed "$seed" --out "$folder"
    quietly "$bin/hovermodal" identify --series "$folder/truth_displacements.csv" --base base --segment "$3" --report "$folder/true_motion"
    for method in hovermodal paper; do
      quietly "$bin/hovermodal" replay --tracks "$folder/tracks.csv" --config "$folder/config.yaml" --set method=$method \
        --set spectrum.segment="$3" --set report.tracks=false --report "$folder/$method"
    done
    compare_to_truth "$folder/hovermodal/modal.json" "$folder" "$folder/table.txt"
    compare_to_truth "$folder/paper/modal.json" "$folder" "$folder/table_paper.txt"
    tables+=("$folder/table.txt")
  done
  judge_modes "$1" "$2 s of tracks, seeds 1-$seeds; $(truth_of "${tables[@]}")" "${tables[@]}"
}

clip_figure 1a 60 build/demo
[ $quick = yes ] || clip_figure 1b 30 "$out/demo30"
track_figure 1c 60 512
track_figure 1d 30 256

# --- 2: tuning forks --------------------------------------------------------------------------------------------------
fork_figure() {  # CLIP LEFT RIGHT
  local rate=${1##*_} nominal=${1#fork_} config=$out/$1.yaml
  rate=${rate%fps} nominal=${nominal%%hz*}
  cat >"$config" <<Y
camera: {driver: file, source: "$data/tuning_forks/$1.mp4", rate_hz: $rate}
regions:
  - {name: left, rect: $2, role: structure, axis: u}
  - {name: right, rect: $3, role: structure, axis: u}
scale: {adaptive: false}
telemetry: {lcm_url: ""}
Y
  quietly "$bin/hovermodald" --config "$config" --report "$out/$1" || { line 2 MISS "the run failed" "-" "$1"; return; }
  # Of the modes within 5 % the one whose prongs move most in phase or against each other is the fork's: not the nearest,
  # which would flatter.
  local found
  found=$("$bin/hovermodal" identify --series "$out/$1/displacements.csv" |
    awk -v n="$nominal" '$2 == "Hz" && $3 == "damping" && $6 == "MPC" { d = $1 / n - 1; if (d < 0) d = -d; if (d < 0.05 && $7 > mpc) { best = $1; bestd = d; mpc = $7 } } END { if (best) printf "%.4f %.3f", best, 100 * bestd; else print "none 100" }')
  judge 2 "${found% *} Hz, ${found#* } % off" "<= 0.3 %" "$1 at $rate fps" "${found#* } <= 0.3"
}

if [ -d "$data/tuning_forks" ]; then
  fork_figure fork_32hz_250fps "[296, 70, 44, 64]" "[352, 70, 50, 64]"
  fork_figure fork_32hz_1000fps "[296, 70, 44, 64]" "[352, 70, 50, 64]"
  fork_figure fork_64hz_250fps "[276, 64, 50, 80]" "[340, 64, 50, 80]"
  fork_figure fork_64hz_500fps "[276, 64, 50, 80]" "[340, 64, 50, 80]"
  fork_figure fork_128hz_500fps "[290, 62, 46, 66]" "[336, 62, 46, 66]"
  fork_figure fork_128hz_1000fps "[290, 74, 46, 66]" "[328, 74, 46, 66]"
else
  line 2 SKIP "no data at $data/tuning_forks" "<= 0.3 %" "tuning forks"
fi

# --- 3: K'nex frame ---------------------------------------------------------------------------------------------------
knex=$data/knex_frame_video
knex_dots() {  # the config that marks each tag of the base row and the row above
  echo "camera: {driver: file, source: \"$knex/knex_1300x2046_gray.mp4\", rate_hz: 20}"
  echo "regions:"
  awk -F, 'NR == 2 { for (t = 0; t < 14; ++t) printf "  - {name: t%02d, rect: [%.0f, %.0f, 44, 44], role: %s, axis: both}\n", t, $(2 + 2 * t) - 22, $(3 + 2 * t) - 22, t < 7 ? "base" : "structure" }' "$knex/target_centroids_px.csv"
}

knex_rows() {  # CAMERA: the config that marks the two rows
  echo "camera: {driver: file, $1}"
  echo "regions:"
  echo "  - {name: base, rect: [120, 1875, 1060, 70], role: base}"
  echo "  - {name: row1, rect: [120, 1385, 1030, 70]}"
  echo "spectrum: {segment: 128}  # free decays of a second, in a record of 29 s"
}

still() {  # a tripod, no telemetry
  echo "scale: {adaptive: false}"
  echo "telemetry: {lcm_url: \"\"}"
}

knex_centroids() {  # worst rms distance over the dots, number of dots, frames with a sample in every dot
  awk -F, '
    FNR == NR { if (FNR > 1) for (t = 0; t < 14; ++t) { cx[FNR - 2, t] = $(2 + 2 * t); cy[FNR - 2, t] = $(3 + 2 * t) } next }
    /^#/ || /^frame/ { next }
    { all = 1
      for (t = 0; t < 14; ++t) {
        u = $(4 + 2 * t); v = $(5 + 2 * t)
        if (u == "" || v == "") { all = 0; continue }
        du = u - cx[$1, t]; dv = v - cy[$1, t]
        n[t]++; su[t] += du; sv[t] += dv; s2[t] += du * du + dv * dv }
      frames += all }
    END { for (t = 0; t < 14; ++t) { r = n[t] ? sqrt(s2[t] / n[t] - (su[t] / n[t]) ^ 2 - (sv[t] / n[t]) ^ 2) : 1e3; if (r > worst) worst = r; sum += r * r }
          printf "%.3f %.3f %d", worst, sqrt(sum / 14), frames }' "$1" "$2"
}

first_mode() {  # the lowest structural mode of a run
  awk '/^\[/ { next } /"modes"/ { on = 1 } on && /"frequency_hz"/ { gsub(/[^0-9.]/, ""); printf "%.4f", $0; exit } /"rejected"/ { exit }' "$1"
}

if [ -d "$knex" ]; then
  { knex_dots; still; } >"$out/knex.yaml"
  quietly "$bin/hovermodald" --config "$out/knex.yaml" --report "$out/knex"
  read -r worst rms frames <<<"$(knex_centroids "$knex/target_centroids_px.csv" "$out/knex/displacements.csv")"
  judge 3a "worst dot $worst px, all dots $rms px rms, $frames of 582 frames with every dot" "<= 0.3 px rms, 582 frames" \
    "K'nex frame: base row and the row above against the given centroids" "$worst <= 0.3 && $frames == 582"

  # Time by the stopwatch filmed in every frame: the median slope over many pairs, because some readings are misread.
  ln -sf "$(realpath "$knex/knex_1300x2046_gray.mp4")" "$out/knex_by_stopwatch.mp4"
  awk -F, 'NR > 1 { t[$1] = $2 } END { for (i = 1; i <= 250; i += 7) for (j = 300; j <= 582; j += 7) if ((i in t) && (j in t)) printf "%.9f\n", (t[j] - t[i]) / (j - i) }' \
    "$knex/stopwatch_readings.csv" | median_and_worst | awk '{ print "frame,t_s"; for (f = 0; f < 582; ++f) printf "%d,%.6f\n", f, f * $1 }' >"$out/knex_by_stopwatch.timestamps.csv"
  { knex_rows "source: \"$knex/knex_1300x2046_gray.mp4\", rate_hz: 20"; still; } >"$out/knex_u.yaml"
  { knex_rows "source: \"$out/knex_by_stopwatch.mp4\""; still; } >"$out/knex_stopwatch.yaml"
  quietly "$bin/hovermodald" --config "$out/knex_u.yaml" --report "$out/knex_declared"
  quietly "$bin/hovermodald" --config "$out/knex_stopwatch.yaml" --report "$out/knex_stopwatch"
  declared=$(first_mode "$out/knex_declared/modal.json") stopwatch=$(first_mode "$out/knex_stopwatch/modal.json")
  rate=$(awk -F, 'NR == 2 { a = $2 } { b = $2 } END { printf "%.4f", 581 / (b - a) }' "$out/knex_by_stopwatch.timestamps.csv")
  judge 3b "first mode ${declared:-none} Hz at the declared 20 fps, ${stopwatch:-none} Hz with the stopwatch's times ($rate fps)" \
    "both found, in the ratio of the rates to 0.1 %" "K'nex frame: the clock is the only difference" \
    "${declared:-0} > 0 && (${stopwatch:-0} / ${declared:-1} / ($rate / 20) - 1) ^ 2 < 1e-6"
else
  line 3 SKIP "no data at $knex" "<= 0.3 px" "K'nex frame"
fi

# --- 4: LCM, in a network of its own (loopback and a multicast route, nothing else) --------------------------------------
small=$out/small
quietly "$bin/hovermodal" simulate --preset paper --size 480x270 --duration 40 --seed 1 --out "$small"
in_private_network() { unshare -rn sh -c 'ip link set lo up && ip route add 224.0.0.0/4 dev lo && exec "$@"' sh "$@"; }
if unshare -rn true 2>/dev/null; then
  in_private_network tools/figures/lcm_run.sh "$small" "$out/lcm" || true
  for part in live log; do
    result=$(cat "$out/lcm/$part.txt" 2>/dev/null || echo "no result")
    case $result in ok*) verdict=ok ;; *) verdict=MISS ;; esac
    what="a second process hears a run over udpm on loopback"
    [ $part = live ] || what="its LCM log replayed by lcm-logplayer"
    line "4$([ $part = live ] && echo a || echo b)" $verdict "${result#* }" "counts equal, sequence unbroken" "$what"
  done
else
  line 4 SKIP "no private network (unshare -rn refused)" "counts equal" "LCM to a second process"
fi

# --- 5: the same replay twice ---------------------------------------------------------------------------------------------
same=yes compared=0
replay_twice() {  # CONFIG
  for k in 1 2; do quietly "$bin/hovermodald" --config "$1" --set telemetry.lcm_url= --report "$out/twice_$k"; done
  for file in modal.json tracks.csv displacements.csv; do
    cmp -s "$out/twice_1/$file" "$out/twice_2/$file" || same=no
    compared=$((compared + 1))
  done
}
replay_twice "$small/config.yaml"
[ ! -d "$data/tuning_forks" ] || replay_twice "$out/fork_64hz_250fps.yaml"
judge 5 "$compared files compared, identical: $same" "byte-identical" "the same clip twice" "\"$same\" == \"yes\" && $compared > 0"

# --- 6: every frame accounted for ------------------------------------------------------------------------------------------
runs=0 wrong=0
while read -r report; do
  runs=$((runs + 1))
  awk '/"frames_in"|"frames_processed"|"frames_dropped"/ { key = $1; gsub(/[^0-9]/, "", $2); v[key] = $2 } END { exit v["\"frames_in\":"] != v["\"frames_processed\":"] + v["\"frames_dropped\":"] || v["\"frames_in\":"] == 0 }' "$report" || wrong=$((wrong + 1))
done < <(find "$out" build/demo -name modal.json -path '*' -newer tools/figures/lib.sh | grep -v true_motion)
quietly tools/build.sh integration_tests
tests="not run" ran=0
if log=$(ctest --test-dir build/release -L integration 2>&1); then tests=pass; else tests=fail; fi
ran=$(echo "$log" | awk '/tests passed/ { print $NF }')
judge 6 "$((runs - wrong)) of $runs runs here; integration tests (which assert it): $tests, $ran" \
  "frames in = processed + dropped, all" "every frame accounted for" "$runs > 0 && $wrong == 0 && \"$tests\" == \"pass\""

[ $misses -eq 0 ]

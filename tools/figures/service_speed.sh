#!/usr/bin/env bash
# The service as a whole: frames a second, the first estimate, memory, and what a fresh machine waits for. One line a figure.
#   tools/figures/service_speed.sh [--quick] [--first-seed N] [FIGURE...]      FIGURE: some of 3 4 6 7 (default: all)
# 3 frames a second on one processor   4 the first estimate of the demo   6 demo and tests from a fresh clone, some 80 minutes
# 7 peak memory. 3 and 6 measure time, beside commit 02909f7, which they build in build/beside: leave the machine alone.
# --quick: a fifth of the frames, and not 6.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/service_speed.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
all_or_named 3 4 6 7
frames=6000 clip_s=40 rounds=3 long_s=600
[ -z "$quick" ] || frames=1200 clip_s=10 rounds=1 long_s=120
former=02909f7
before=build/beside/$former
out=build/figures/service_speed
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh service_speed hovermodal hovermodald

clone_of() { # COMMIT FOLDER: a clone of this project at that commit
  [ -d "$2/.git" ] || { git clone -q --no-checkout . "$2.new" && git -C "$2.new" checkout -q "$1" && mv "$2.new" "$2"; }
}
ratio() { awk -v a="$1" -v b="$2" 'BEGIN { printf "%.2f", a / b }'; }
clip() { # NAME SECONDS: a drawn clip of 1080p and its configuration, 30 points in each of eight regions
  [ -e "$out/$1/config.yaml" ] || quietly "$bin/hovermodal" simulate --scene tools/scenes/facade.yaml --size 1080p --duration "$2" --seed "$first_seed" --out "$out/$1"
}
many_points=(--set tracking.points_per_region=30 --set tracking.min_distance_px=8)

# --- 3: frames a second ---------------------------------------------------------------------------------------------------
raw() { # HEIGHT: frames a second, points
  "$bin/service_speed" "$frames" "$first_seed" "$1" >"$out/raw_$1.txt"
  awk -F'\t' '$1 == "rate" { rate = $2 } $1 == "points" { points = $2 } END { print rate, points }' "$out/raw_$1.txt"
}
stages() { awk -F'\t' 'NF == 3 { printf "%s%s %s us", (n++ ? ", " : ""), $1, $2 }' "$out/raw_$1.txt"; } # HEIGHT
watch() { # PROGRAM: seconds that it takes for the clip, on one processor
  local begin end
  begin=$(date +%s%N)
  taskset -c 0 "$1" --config "$out/clip/config.yaml" --set telemetry.lcm_url= "${many_points[@]}" >"$out/watch.log" 2>&1
  end=$(date +%s%N)
  awk -v n=$((end - begin)) 'BEGIN { printf "%.3f\n", n * 1e-9 }'
}
figure_3() {
  local rate points round ours theirs n=$((clip_s * 25))
  read -r rate points < <(raw 1080)
  judge 3a "$rate frames/s, $points points" "raw 1080p, 240 points: >= 1 200 frames/s" "whole service on one core; $(stages 1080)" "$rate >= 1200"
  clip clip $clip_s
  clone_of $former "$before"
  (cd "$before" && quietly tools/build.sh hovermodald)
  : >"$out/ours.txt" && : >"$out/theirs.txt"
  for ((round = 0; round < rounds; ++round)); do
    watch "$bin/hovermodald" >>"$out/ours.txt"
    watch "$before/build/release/bin/hovermodald" >>"$out/theirs.txt"
  done
  read -r ours _ < <(median_and_worst <"$out/ours.txt")
  read -r theirs _ < <(median_and_worst <"$out/theirs.txt")
  judge 3b "$(ratio "$theirs" "$ours") times: $(ratio $n "$ours") frames/s against $(ratio $n "$theirs")" \
    "with H.264 decoding on one core >= 1.5 times today's in the same run" \
    "$n frames of 1080p H.264, start and end of the program included, against $former, median of $rounds" "$theirs >= 1.5 * $ours"
  decoding
  read -r rate points < <(raw 2160)
  judge 3c "$rate frames/s, $points points: $(ratio "$rate" 30) times the camera's" "4K30 raw on one core with margin 10" "whole service; $(stages 2160)" "$rate >= 300"
}
# What no program can fall below that decodes the clip by the same library.
decoding() {
  quietly tools/build.sh decode_speed
  line 3 beside "$(taskset -c 0 "$bin/decode_speed" "$out/clip/clip.mp4" 2>&1 | tr '\t\n' '  ')" "-" "the same clip decoded only, on one core"
}

# --- 4: the first estimate --------------------------------------------------------------------------------------------------
figure_4() {
  local demo=$out/demo log=$PWD/$out/demo.lcm first second what="the demo's clip, spectrum.segment 512, 25 fps"
  [ -e "$demo/config.yaml" ] || quietly "$bin/hovermodal" simulate --scene tools/scenes/facade.yaml --duration 60 --seed 1 --out "$demo"
  rm -f "$log"
  quietly "$bin/hovermodald" --config "$demo/config.yaml" --set "telemetry.lcm_url=file://$log?mode=w" --set spectrum.segment=512
  quietly tools/build.sh hovermodal_python_messages
  python3 -B tools/figures/lcm_log.py estimates "$log" build/release/python >"$out/estimates.txt"
  read -r first < <(awk 'NR == 1' "$out/estimates.txt") && read -r second < <(awk 'NR == 2' "$out/estimates.txt")
  judge 4a "${first:-none}" "First estimate after 20.5 s of stream at 25 fps, segment 512 (seen on the demo)" "$what: stream time, structural modes, those with a sigma" \
    "$(awk 'NR == 1 { print $1, "<= 20.5 &&", $2, "> 0" }' "$out/estimates.txt")"
  judge 4b "${second:-none}" "sigma with the second" "the same, the second estimate" "$(awk 'NR == 2 { print $2, "> 0 &&", $3, "==", $2 }' "$out/estimates.txt")"
}

# --- 6: a fresh machine -------------------------------------------------------------------------------------------------------
minutes_of() { # FOLDER COMMAND: minutes
  local begin=$SECONDS
  (cd "$1" && CCACHE_DISABLE=1 quietly "$2") || echo "$2 failed in $1" >&2
  awk -v s=$((SECONDS - begin)) 'BEGIN { printf "%.1f", s / 60 }'
}
figure_6() {
  local what command ours theirs
  what="fresh clone, no compiler cache, $(nproc) processors"
  if [ -n "$quick" ]; then line 6 SKIP "--quick" "minutes and ratio to $former in one run" "cold demo, cold tests" && return; fi
  for command in demo test; do
    rm -rf "$out/now" "$out/then"
    clone_of HEAD "$out/now" && clone_of $former "$out/then"
    ours=$(minutes_of "$out/now" "tools/$command.sh") theirs=$(minutes_of "$out/then" "tools/$command.sh")
    if [ $command = demo ]; then
      judge 6a "$ours min; $former: $theirs min, ratio $(ratio "$ours" "$theirs")" "Demo from nothing on two cores within eight minutes; minutes and ratio to 02909f7 in one run" "cold demo, $what" "$ours <= 8"
    else
      line 6b beside "$ours min; $former: $theirs min, ratio $(ratio "$ours" "$theirs")" "minutes and ratio to 02909f7 in one run" "cold tests, $what"
    fi
  done
  rm -rf "$out/now" "$out/then"
}

# --- 7: memory ----------------------------------------------------------------------------------------------------------------
figure_7() {
  local peak middle_mb last_mb
  clip long $long_s
  rm -rf "$out/record"
  "$bin/hovermodald" --config "$out/long/config.yaml" --set telemetry.lcm_url= "${many_points[@]}" --set closure.adopt=auto \
    --set "record.directory=$out/record" >"$out/long.log" 2>&1 &
  resident_of $! >"$out/resident.txt"
  wait $! || { line 7 MISS "the service ended with an error, see $out/long.log" "<= 250 MB, flat" "peak memory" && return; }
  rm -rf "$out/record"
  read -r peak middle_mb last_mb < <(awk '{ v[NR] = $1 } END {
    for (i = 1; i <= NR; ++i) { p = v[i] > p ? v[i] : p; if (i > NR / 3 && i <= 2 * NR / 3 && v[i] > m) m = v[i]; if (i > 2 * NR / 3 && v[i] > l) l = v[i] }
    print p, m, l }' "$out/resident.txt")
  judge 7 "peak $peak MB; highest of the middle third $middle_mb MB, of the last $last_mb MB" "<= 250 MB, flat" \
    "resident memory of the service at 1080p, 240 points, closure and record on, $long_s s of H.264; flat: the last third at most 1 % above the middle one" \
    "$peak > 0 && $peak <= 250 && $last_mb <= 1.01 * $middle_mb"
}
resident_of() { # PROCESS: MB, five times a second, until it ends
  local kb
  while kb=$(awk '/^VmRSS/ { print $2 }' "/proc/$1/status" 2>/dev/null) && [ -n "$kb" ]; do
    awk -v kb="$kb" 'BEGIN { printf "%.1f\n", kb / 1000 }'
    sleep 0.2
  done
}

run_figures "${figures[@]}"

# Figures 2 and 3 of the main job: filmed video. Sourced by main_job.sh.

# --- 2: tuning forks --------------------------------------------------------------------------------------------------
fork_config() {  # CLIP RATE LEFT RIGHT: into CLIP.yaml
  cat >"$out/$1.yaml" <<Y
camera: {driver: file, source: "$data/tuning_forks/$1.mp4", rate_hz: $2}
regions:
  - {name: left, rect: $3, role: structure, axis: u}
  - {name: right, rect: $4, role: structure, axis: u}
scale: {adaptive: false}
telemetry: {lcm_url: ""}
Y
}
fork_figure() {  # CLIP LEFT RIGHT
  local rate=${1##*_} nominal=${1#fork_} found
  rate=${rate%fps} nominal=${nominal%%hz*}
  fork_config "$1" "$rate" "$2" "$3"
  quietly "$bin/hovermodald" --config "$out/$1.yaml" --report "$out/$1" || { line 2 MISS "the run failed" "-" "$1"; return; }
  # Of the modes within 5 %, the fork's is the one whose prongs move most clearly in phase or antiphase, not the nearest one,
  # which would bias the result.
  found=$("$bin/hovermodal" identify --json --series "$out/$1/displacements.csv" | python3 -c '
import json, sys
nominal = float(sys.argv[1])
near = [(m["mpc"], m["frequency_hz"]) for m in json.load(sys.stdin)["modes"] if abs(m["frequency_hz"] / nominal - 1) < 0.05]
hz = max(near)[1] if near else None
print(f"{hz:.4f} {100 * abs(hz / nominal - 1):.3f}" if near else "none 100")' "$nominal")
  judge 2 "${found% *} Hz, ${found#* } % off" "<= 0.3 %" "$1 at $rate fps" "${found#* } <= 0.3"
}
figure_2() {
  if [ -d "$data/tuning_forks" ]; then
    fork_figure fork_32hz_250fps "[296, 70, 44, 64]" "[352, 70, 50, 64]"
    fork_figure fork_32hz_1000fps "[296, 70, 44, 64]" "[352, 70, 50, 64]"
    fork_figure fork_64hz_250fps "[276, 64, 50, 80]" "[340, 64, 50, 80]"
    fork_figure fork_64hz_500fps "[276, 64, 50, 80]" "[340, 64, 50, 80]"
    fork_figure fork_128hz_500fps "[290, 62, 46, 66]" "[336, 62, 46, 66]"
    fork_figure fork_128hz_1000fps "[290, 74, 46, 66]" "[328, 74, 46, 66]"
  else
    line 2 SKIP "no data at $data/tuning_forks" "<= 0.3 %" "tuning forks (HOVERMODAL_DATA names the folder)"
  fi
}

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

figure_3() {
  local worst rms frames declared stopwatch rate
  if [ -d "$knex" ]; then
    { knex_dots; still; } >"$out/knex.yaml"
    quietly "$bin/hovermodald" --config "$out/knex.yaml" --report "$out/knex"
    read -r worst rms frames <<<"$(knex_centroids "$knex/target_centroids_px.csv" "$out/knex/displacements.csv")"
    judge 3a "worst dot $worst px, all dots $rms px rms, $frames of 582 frames with every dot" "<= 0.3 px rms, 582 frames" \
      "K'nex frame: base row and the row above against the given centroids" "$worst <= 0.3 && $frames == 582"

    # Time by the stopwatch filmed in every frame: the median slope over many pairs, because some readings are wrong.
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
    line 3 SKIP "no data at $knex" "<= 0.3 px" "K'nex frame (HOVERMODAL_DATA names the folder)"
  fi
}

# Figures 10 (clips, demo) and 15 of residual diagnosis: rendered records not simulated by the model's formulas. Sourced by
# closure.sh.

# foreign_clip NAME SEED [EFFECT [STRENGTH]]: a drawn scene of 640 x 360 in $out/NAME, rendered with little loss.
foreign_clip() {
  local folder=$out/$1 arguments=(--first-seed "$2" --duration "$clip_s")
  if [ -f "$data/phantom4_hover/flight_10hz.csv" ]; then arguments+=(--flight "$data/phantom4_hover/flight_10hz.csv"); fi
  if [ -n "${3:-}" ]; then arguments+=(--effect "$3" --strength "${4:-1}"); fi
  "$bin/hovermodal-validate" closure-clip-foreign "${arguments[@]}" >"$folder.yaml"
  rm -rf "$folder"
  quietly "$bin/hovermodal" simulate --scene "$folder.yaml" --size 640x360 --crf 6 --out "$folder" --threads "$(nproc)"
}
# foreign_coded NAME BITS [CODEC]: its clip encoded again by libx264 or libx265 with BITS per pixel, in $out/NAME_BITS.mp4.
foreign_coded() {
  local rate
  rate=$(sed -n 's/^ *rate_hz: *//p' "$out/$1/config.yaml" | head -n 1)
  quietly ffmpeg -nostdin -y -i "$out/$1/clip.mp4" -c:v "${3:-libx264}" -preset medium -b:v "$(awk "BEGIN { printf \"%.0f\", $2 * 640 * 360 * $rate }")" \
    -pix_fmt yuvj420p "$out/$1_$2.mp4"
}
# foreign_run NAME FOLDER CLIP [--set KEY=VALUE]: the service on the clip; report in $out/NAME_run.
foreign_run() {
  quietly "$bin/hovermodald" --config "$out/$2/config.yaml" --set "camera.source=$3" --set tracking.points_per_region=12 --set telemetry.lcm_url= \
    "${@:4}" --report "$out/$1_run"
}
foreign_closed() { # the same, then residual diagnosis; report in $out/NAME
  foreign_run "$@"
  closeloop "$1" --record "$out/$1_run" --config "$out/$2/config.yaml" --set "camera.source=$3" --set tracking.points_per_region=12 "${@:4}"
}
# foreign_answer NAME LOOP: 1 if exactly the scene's effect was named; 1 if its parameters lie within 3 sigma; number of parameters.
foreign_answer() {
  python3 - "$out/$1.yaml" "$out/$2/closure.json" <<'PY'
import json, sys
names, truth = set(), {}
for row in open(sys.argv[1]):
    f = row.rstrip("\n").split("\t")
    if f[0] == "# name":
        names.add(f[1])
    elif f[0] == "# truth":
        truth[f[1]] = float(f[2])
steps = json.load(open(sys.argv[2]))["steps"]
right = bool(steps) and all(s["effect"] in names for s in steps)
errors = [abs(p["value"] - truth[k]) / p["sigma"] for s in steps for k, p in s["parameters"].items() if right and k in truth and p.get("sigma")]
print(int(right), int(all(e <= 3 for e in errors)), len(errors))
PY
}
adopted() { ask "$1" '" + ".join(sorted(s)) or "nothing"'; }

# --- 10: clips without an effect -------------------------------------------------------------------------------------------
figure_10_clips() {
  local i seed name said false_ones=0 n=0 listed=
  for ((i = 0; i < null_clips / 2; i++)); do
    seed=$((first_seed + i)) name=null_$i
    foreign_clip "$name" "$seed"
    foreign_coded "$name" 0.4
    foreign_closed "${name}_rendered" "$name" "$PWD/$out/$name/clip.mp4"
    foreign_closed "${name}_h264" "$name" "$PWD/$out/${name}_0.4.mp4"
    for said in rendered h264; do
      n=$((n + 1))
      echo "# seed $seed $said: $(adopted "${name}_$said"), residual before $(ask "${name}_$said" 'f"""{c["baseline"]["residual_rms"]:.4f}, floor {c["baseline"]["noise_floor"]:.4f}"""') px; $(sed -n 's/^# //p' "$out/$name.yaml" | head -n 1)"
      [ "$(adopted "${name}_$said")" = nothing ] || { false_ones=$((false_ones + 1)) listed+=" $seed $said: $(adopted "${name}_$said");"; }
    done
    rm -f "$out/$name/clip.mp4" "$out/${name}_0.4.mp4"
  done
  judge 10c "$false_ones of $n adopt:${listed:- nothing}" "40 rendered clips (640 x 360, 60 s, both rendered and H.264, recorded hover among them): at most 1" \
    "each drawn scene with little loss and at 0.4 bits a pixel; $(recorded_or_not)" "$false_ones <= $n / 40"
}
figure_10_demo() {
  local folder=$out/demo
  rm -rf "$folder"
  quietly "$bin/hovermodal" simulate --preset paper --duration 60 --seed "$first_seed" --out "$folder" --threads "$(nproc)"
  quietly "$bin/hovermodald" --config "$folder/config.yaml" --set telemetry.lcm_url= --set closure.least_px=0.002 --report "$folder/run"
  cp "$folder/run/closure.json" "$folder/closure.json"
  rm -f "$folder/clip.mp4"
  judge 10d "$(adopted demo)" 'The demo ends with "nothing unexplained" and `least_px` lowered to 0.002' "the demo's clip through the service" \
    "$(ask demo 'len(c["steps"])') == 0"
}

# --- 15: clips with an effect ----------------------------------------------------------------------------------------------
figure_15() {
  local effects=("readout time" "radial distortion" "tangential distortion" "camera roll" "camera pitch" "camera yaw" "rotor line"
    "gimbal vibration" "whole lens" "fisheye" "oblique view" "rocking" "sway" "flap")
  local i name effect right within numbers named=0 kept=0
  for ((i = 0; i < effect_clips; i++)); do
    effect=${effects[i % ${#effects[@]}]} name=effect_$i
    foreign_clip "$name" "$((first_seed + i))" "$effect"
    foreign_closed "${name}_loop" "$name" "$PWD/$out/$name/clip.mp4"
    rm -f "$out/$name/clip.mp4"
    read -r right within numbers < <(foreign_answer "$name" "${name}_loop")
    named=$((named + right)) kept=$((kept + (right && within)))
    echo "# seed $((first_seed + i)) $effect: $(adopted "${name}_loop"), numbers within 3 sigma $within ($numbers)"
  done
  judge 15 "$named of $effect_clips named and nothing else, with numbers within 3 sigma $kept" \
    "every catalogue effect of figure 11 at strength 1 on rendered clips (20 clips, 60 s, recorded hover): named and nothing else in 85 %, numbers within 3 sigma" \
    "one effect a clip, 640 x 360; $(recorded_or_not)" "$named >= 0.85 * $effect_clips && $kept == $named"
}

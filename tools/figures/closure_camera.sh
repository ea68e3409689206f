# Figures 8 and 9 of closing the loop: a measured camera; pixels. Sourced by closure.sh.

# --- 8: a phone in a car, its gyro beside it -------------------------------------------------------------------------------
figure_8() { line 8 SKIP "-" "-" "not there yet"; }

# --- 9: rendered clips, through the service ------------------------------------------------------------------------------
clip() { # NAME SECONDS SCENE: drawn, followed, and the modes of its true motion
  local folder=$out/clip_$1
  printf 'preset: paper\nduration_s: %s\n%s\n' "$2" "$3" >"$folder.yaml"
  rm -rf "$folder"
  quietly "$bin/hovermodal" simulate --scene "$folder.yaml" --size 720p --out "$folder" --threads "$(nproc)"
  quietly "$bin/hovermodal" identify --series "$folder/truth_displacements.csv" --base base --report "$folder/truth"
  quietly "$bin/hovermodald" --config "$folder/config.yaml" --set "$points" --set telemetry.lcm_url= --report "$folder/run"
  rm -f "$folder/clip.mp4" # some 80 MB
}
pixels() { # NAME EFFECT WHAT: from the reports of $out/pixels_NAME
  local before after mac_before mac_after
  read -r before after mac_before mac_after < <(ask "pixels_$1" 'f"""{rms(errors("modes_before")):.3f} {rms(errors("modes_after")):.3f} {min(errors("modes_before", "mac")):.4f} {min(errors("modes_after", "mac")):.4f}"""')
  judge "9.$1" "frequencies $before -> $after % rms, MAC $mac_before -> $mac_after (least of $(ask "pixels_$1" 'len(errors("modes_after"))') modes): $(ask "pixels_$1" '", ".join(f"""{n} ({e["heldout_before"]:.4f} -> {e["heldout_after"]:.4f})""" for n, e in s.items()) or "nothing"')" \
    "effect named, modal error not worse" "$3" \
    "$(ask "pixels_$1" "int('$2' in s)") == 1 && $after <= 1.05 * $before + 0.01 && $mac_after >= $mac_before - 0.002"
}
figure_9() {
  local seconds=60 points=tracking.points_per_region=12 name=
  [ "$few" -gt 2 ] || seconds=40
  clip readout "$seconds" "seed: $first
camera: {readout_ms: 30}
declare: {readout_ms: false}"
  clip lens "$seconds" "seed: $((first + 1))
camera: {lens: {model: radial_tangential, k: [-0.15, 0, 0, 0, 0]}}
declare: {lens: false}"
  clip lost "$seconds" "seed: $((first + 2))
timing: {drop_probability: 0.02}
declare: {timestamps: false}"
  for name in readout lens; do
    closeloop "pixels_$name" --record "$out/clip_$name/run" --config "$out/clip_$name/config.yaml" --set "$points" \
      --reference "$out/clip_$name/truth/modal.json"
  done
  closeloop pixels_lost --record "$out/clip_lost/run/displacements.csv" --base base --reference "$out/clip_lost/truth/modal.json"
  pixels readout "readout time" "clip of $seconds s, readout of 30 ms not declared"
  pixels lens "radial distortion" "clip of $seconds s, k1 of -0.15 not declared"
  pixels lost dropped_frames "clip of $seconds s, one frame in fifty lost without a trace"
}

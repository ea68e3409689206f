# Figures 8 and 9 of residual diagnosis: a measured camera; pixels. Sourced by closure.sh.

# --- 8: a phone in a car, its gyro beside it -------------------------------------------------------------------------------
figure_8() {
  local phone=$data/phone_rolling_shutter_gyro what="measured clip, phone in a car, declared as a global shutter that does not turn"
  local bar="effects found; residual on held-out frames lower after each; disagreement with the gyro at most a tenth"
  if [ ! -d "$phone/frames" ]; then
    line 8 SKIP "no data at $phone" "$bar" "$what"
    return
  fi
  closeloop phone --clip "$phone/frames" --stamps "$phone/framestamp.txt" --first-stamp 99 --gyro "$phone/gyro.txt" --focal-px 574.4 \
    --ignore 0,400,800,200
  judge 8 "held-out frames $(ask phone '"; ".join(f"""{n} ({e["heldout_before"]:.3f} -> {e["heldout_after"]:.3f} px, chance {e["threshold"] / e["score"]:.2g} of the gain)""" for n, e in s.items())'), readout $(ask phone '"%.1f +- %.1f ms" % tuple(s["readout time"]["parameters"]["readout"][k] for k in ("value", "sigma")) if "readout time" in s else "not found"'); the picture turns beyond the model $(ask phone 'f"""{c["reference_error_before"]:.4f} -> {c["reference_error_after"]:.4f}"""') deg rms a frame" \
    "$bar" "$what" \
    "$(ask phone 'int(list(s) == ["camera rotation", "readout time"] and all(e["heldout_after"] < e["heldout_before"] for e in c["steps"]))') == 1 && $(ask phone 'f"""{c["reference_error_after"] / c["reference_error_before"]:.4f}"""') <= 0.1"
}

# --- 9: rendered clips, through the service ------------------------------------------------------------------------------
clip() { # NAME SEED EFFECT: a drawn scene with the effect, rendered and processed, and the modes of its true motion
  local folder=$out/clip_$1
  "$bin/hovermodal-validate" closure-clip --first-seed "$2" --duration "$clip_s" --effect "$3" >"$folder.yaml"
  rm -rf "$folder"
  quietly "$bin/hovermodal" simulate --scene "$folder.yaml" --size 720p --out "$folder" --threads "$(nproc)"
  quietly "$bin/hovermodal" identify --series "$folder/truth_displacements.csv" --base base --report "$folder/truth"
  quietly "$bin/hovermodald" --config "$folder/config.yaml" --set "$points" --set telemetry.lcm_url= --report "$folder/run"
  rm -f "$folder/clip.mp4" # some 80 MB
}
pixels() { # NAME EFFECT WHAT: from the reports of $out/pixels_NAME; errors and MAC over the modes found both before and after
  local before after found_before found_after mac_before mac_after
  read -r before after found_before found_after mac_before mac_after < <(ask "pixels_$1" 'f"""{" ".join(f"{rms(v):.3f}" for v in zip(*common())) or "nan nan"} {len(errors("modes_before"))} {len(errors("modes_after"))} {" ".join(common_macs())}"""')
  judge "9.$1" "modes found $found_before -> $found_after, frequency error $before -> $after % rms, least MAC $mac_before -> $mac_after: $(ask "pixels_$1" '", ".join(f"""{n} ({e["heldout_before"]:.4f} -> {e["heldout_after"]:.4f})""" for n, e in s.items()) or "nothing"')" \
    "effect named, nothing else named, modal error (frequency rms, least MAC) not worse" "$3" \
    "$(ask "pixels_$1" "int(list(s) == ['$2'])") == 1 && $found_after >= $found_before && $after <= $before && $mac_after >= $mac_before"
}
figure_9() {
  local points=tracking.points_per_region=12 name=
  clip readout "$first_seed" "readout time"
  clip lens "$((first_seed + 1))" "radial distortion"
  clip lost "$((first_seed + 2))" "dropped frames"
  for name in readout lens; do
    closeloop "pixels_$name" --record "$out/clip_$name/run" --config "$out/clip_$name/config.yaml" --set "$points" \
      --reference "$out/clip_$name/truth/modal.json"
  done
  closeloop pixels_lost --record "$out/clip_lost/run/displacements.csv" --base base --reference "$out/clip_lost/truth/modal.json"
  pixels readout "readout time" "drawn clip of $clip_s s, readout declared wrong by up to half a frame"
  pixels lens "radial distortion" "drawn clip of $clip_s s, k1 of 0.18 of either sign not declared"
  pixels lost dropped_frames "drawn clip of $clip_s s, one frame in fifty lost without a trace"
}

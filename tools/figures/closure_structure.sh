# Figures 4 and 5 of residual diagnosis: structures. Sourced by closure.sh.
frame() { printf 'structure: {kind: shear_frame, %s}\n' "$2" >"$out/$1.yaml"; }
table() { printf 'frequency_hz\n' >"$out/$1.csv"; printf '%s\n' "${@:2}" >>"$out/$1.csv"; }

# --- 4: measured frames ------------------------------------------------------------------------------------------------
figure_4() {
  frame paper "storeys: 6"
  table paper 1.657 5.04 8.14 10.83 12.93 14.34
  table paper_accelerometer 1.632 5.054 8.175
  closeloop paper --structure "$out/paper.yaml" --reference "$out/paper.csv" --check "$out/paper_accelerometer.csv"
  read -r before worst after < <(ask paper 'f"""{c["baseline"]["residual_rms"]:.2f} {worst("modes_before"):.2f} {rms(errors("modes_after")):.3f}"""')
  judge 4a "before $before % rms, $worst % worst; after $after % rms: $(ask paper 'told()')" "before 2.3 % rms, 4.3 % worst; after at most 0.25 % rms" \
    "six stated frequencies against a uniform shear frame" \
    "$before > 2.25 && $before < 2.36 && $worst > 4.2 && $worst < 4.4 && $after <= 0.25"
  sound=$(ask paper 'int("gravity_softening" in s and len(s) == 2 and all(not (name in ("ground_storey", "roof_mass") and not ({"ground_storey", "roof_mass"} - {name}) <= set(e["rivals"])) for name, e in s.items()))')
  falls=$(ask paper 'int(all(e["heldout_after"] < e["heldout_before"] for e in c["steps"]))')
  height=$(ask paper 'f"""{9806.65 / s["gravity_softening"]["parameters"]["gravity_over_height"]["value"]:.0f}""" if "gravity_softening" in s else "nan"')
  judge 4b "storey height implied $height mm, partner named with its rivals: $sound, leave-one-out error fell at each step: $falls" \
    "added only while the leave-one-out error falls; parameters physically plausible (storey height near 0.12 m); rivals that cannot be told apart named" "the same: ground storey and roof mass cannot be told apart" \
    "$height >= 80 && $height <= 160 && $sound == 1 && $falls == 1"
  line 4c beside "$(ask paper 'f"""{c["reference_error_before"]:.2f} -> {c["reference_error_after"]:.2f} % rms"""'): $(grep -A 4 'excluded from the fit (--check)' "$out/paper.txt" | tail -n +2 | awk '$1 + 0 > 0 { printf "%s Hz %s %%  ", $3, $4 }')" \
    "predicted with its error" "the accelerometers' three frequencies, which no fit saw"

  if [ -d "$data/mini_shake_table" ]; then
    rm -rf "$out/shake_identified"
    quietly "$bin/hovermodal" identify --series "$data/mini_shake_table/flexible_northridge.csv" --input ground_m_s2 \
      --max-frequency 24 --report "$out/shake_identified"
    frame shake "storeys: 3, floors: [floor1_m_s2, floor2_m_s2, floor3_m_s2]"
    closeloop shake --structure "$out/shake.yaml" --reference "$out/shake_identified/modal.json"
    judge 4d "frequency $(ask shake 'f"""{c["baseline"]["residual_rms"]:.2f} -> {rms(errors("modes_after")):.2f} % rms, MAC {min(errors("modes_before", "mac")):.4f} -> {min(errors("modes_after", "mac")):.4f} (least)"""'): $(ask shake 'told()')" \
      "at most one effect; MAC and frequency error before and after" "three-storey frame on a shake table, frequencies and shapes" "$(ask shake 'len(c["steps"])') <= 1"
  else
    line 4d SKIP "-" "-" "no $data/mini_shake_table"
  fi
}

# --- 5: a published simulation against its stated truth ----------------------------------------------------------------
figure_5() {
  if [ -d "$data/published_shear_frame" ]; then
    rm -rf "$out/published_identified"
    quietly "$bin/hovermodal" identify --series "$data/published_shear_frame/accelerations.csv" --quantity a \
      --max-frequency 2 --report "$out/published_identified"
    # The stated truth 1.13852 3.32332 5.23889 6.73003 7.67594 rad/s is the uniform frame of k / m = 16 / s^2.
    frame published "storeys: 5, stiffness_over_mass_per_s2: 16, data: simulated, dt_s: 0.083333333"
    closeloop published --structure "$out/published.yaml" --reference "$out/published_identified/modal.json"
    frame published_free "storeys: 5, stiffness_over_mass_per_s2: 16, data: simulated"
    closeloop published_free --structure "$out/published_free.yaml" --reference "$out/published_identified/modal.json"
    read -r mode_1 others < <(ask published 'f"""{abs(errors("modes_after")[0]):.3f} {max(abs(e) for e in errors("modes_after")[1:]):.3f}"""')
    judge 5a "worst $(ask published 'f"""{worst("modes_before"):.2f}"""') % before; after: mode 1 $mode_1 %, others $others %: $(ask published 'told()')" \
      "traced; after at most 0.3 % (mode 1: 0.6 %)" "published simulation against its stated truth, step known" \
      "$mode_1 <= 0.6 && $others <= 0.3 && $(ask published 'int(list(s) == ["integrator"])') == 1"
    line 5b beside "$(ask published_free 'told()'); $(ask published_free '", ".join(f"""{n} {p["value"]:.4f} +- {p["sigma"] or 0:.4f} {p["unit"]}""" for e in c["steps"] for n, p in e["parameters"].items())')" \
      "-" "the same, step not known (true 0.0833 s)"
  else
    for number in 5a 5b; do line "$number" SKIP "-" "-" "no $data/published_shear_frame"; done
  fi
}

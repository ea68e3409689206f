# Figures 6 and 7 of residual diagnosis: measured responses. Sourced by closure.sh.
# --- 6: measured video: the clock, then the free decays ------------------------------------------------------------------
figure_6() {
  local knex=$data/knex_frame_video
  if [ ! -d "$knex" ]; then
    for number in 6a 6b; do line "$number" SKIP "-" "-" "no $knex"; done
    return
  fi
  knex_config >"$out/knex.yaml"
  quietly "$bin/hovermodald" --config "$out/knex.yaml" --report "$out/knex"
  local filmed=(--record "$out/knex/displacements.csv" --rate 20 --base base --clock "$knex/stopwatch_readings.csv" --clock-sigma-ms 13)
  closeloop knex_clock "${filmed[@]}"
  local before after rate
  read -r before after rate < <(ask knex_clock 'f"""{c["reference_error_before"]:.0f} {c["reference_error_after"]:.1f} {s["clock_rate"]["parameters"]["rate"]["value"]:.3f}""" if "clock_rate" in s else "nan nan nan"')
  judge 6a "$before -> $after ms rms on readings that the fit did not see ($(head -1 "$out/knex_clock.txt" | cut -d, -f1-2)); $rate Hz for the declared 20: $(ask knex_clock '", ".join(s)'); modes $(ask knex_clock 'modes_hz("modes_before") + " -> " + modes_hz("modes_after")') Hz" \
    "held-out readings: before; after at most 1.1 times the 13 ms reading scatter" "K'nex video, declared 20 fps, stopwatch in the picture" "$after <= 14.3 && $before > 100"
  closeloop knex_decay "${filmed[@]}" --free-decay
  read -r before after < <(ask knex_decay 'f"""{c["reference_error_before"]:.3f} {c["reference_error_after"]:.3f}"""')
  judge 6b "$before -> $after px rms on releases that the fit did not see: $(ask knex_decay '"; ".join(f"""{e["effect"]} ({e["heldout_before"]:.2f} -> {e["heldout_after"]:.2f} px)""" for e in c["steps"])')" \
    "traced; on releases that the fit did not see at least threefold lower" "its free decays against a linear mode, 7 releases" "$before >= 3 * $after && $after > 0"
}

# --- 7: measured input colour, measured clocks -----------------------------------------------------------------------------
figure_7() {
  local shake=$data/mini_shake_table
  if [ ! -d "$shake" ]; then
    for number in 7a 7b; do line "$number" SKIP "-" "-" "no $shake"; done
    return
  fi
  rm -rf "$out/shake_identified"
  quietly "$bin/hovermodal" identify --series "$shake/flexible_northridge.csv" --input ground_m_s2 --max-frequency 24 --report "$out/shake_identified"
  # The reference: peaks of the measured response to the ground.
  "$bin/hovermodal" identify --series "$shake/flexible_northridge.csv" --input ground_m_s2 --max-frequency 24 2>"$out/peaks.log" |
    awk 'BEGIN { print "frequency_hz" } on && $2 == "Hz" { print $1 } /^response to the input/ { on = 1 }' >"$out/shake_peaks.csv"
  closeloop shake_input --record "$shake/flexible_northridge.csv" --input ground_m_s2 --input-unknown --max-frequency 24 --reference "$out/shake_peaks.csv"
  local before after true_before true_after
  read -r before after true_before true_after < <(ask shake_input '" ".join(str(sum((m["reference_hz"] is None) == false for m in c[key])) for false in (True, False) for key in ("modes_before", "modes_after"))')
  judge 7a "false modes $before -> $after, true ones $true_before -> $true_after of $(($(wc -l <"$out/shake_peaks.csv") - 1)); held-out innovations $(ask shake_input 'f"""{c["reference_error_before"]:.2f} -> {c["reference_error_after"]:.2f}"""'): $(ask shake_input '", ".join(s) or "nothing"')$(ask shake_input '"".join("; " + r["effect"] + " " + r["reason"] for r in c["refused"] if "from zero" in r["reason"])')" \
    "false modes before, after: fewer, traced to the input's colour, no true mode lost" "shake table under an earthquake, the ground not declared" \
    "$after < $before && $true_after >= $true_before && $(ask shake_input 'int("input_colour" in s)') == 1"
  mkdir -p "$out/logger_tables"
  for name in ground floor1 floor2 floor3; do ln -sf "$(realpath "$shake/flexible_bonus_$name.csv")" "$out/logger_tables/${name}_m_s2.csv"; done
  closeloop loggers --record "$out"/logger_tables/{ground,floor1,floor2,floor3}_m_s2.csv --quantity a --input-record ground_m_s2 --max-frequency 24 \
    --reference "$out/shake_identified/modal.json"
  judge 7b "MAC $(ask loggers 'macs("modes_before") + " -> " + macs("modes_after")'); offsets $(ask loggers '", ".join(f"""{n} {p["value"]:+.1f} +- {p["sigma"]:.1f} ms""" for n, p in s["clock_offset"]["parameters"].items()) if "clock_offset" in s else "none"'); $(ask loggers '", ".join(s)')" \
    "offsets found with sigma; MAC of the shapes against Northridge's at least 0.98" "four loggers that were not synchronised" \
    "$(ask loggers 'int("clock_offset" in s and all(p["sigma"] for p in s["clock_offset"]["parameters"].values()) and len([m for m in c["modes_after"] if m["mac"] is not None and m["mac"] >= 0.98]) >= 3 and all(m["mac"] >= 0.98 for m in c["modes_after"] if m["mac"] is not None))') == 1"
}

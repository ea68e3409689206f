# Figure 5 of structures.sh, which sources this: structures that others measured.
# shellcheck shell=bash disable=SC2154

# loop NAME REFERENCE: STRUCTURE on standard input; the report in $out/measured/NAME.
loop() {
  local here=$out/measured
  mkdir -p "$here/$1"
  { echo "structure:" && sed 's/^/  /'; } >"$here/$1.yaml"
  "$bin/hovermodal" closeloop --structure "$here/$1.yaml" --reference "$2" --report "$here/$1" >"$here/$1.txt" 2>&1 || true
}

# told NAME: errors of the frequencies before and after, what was named, modes that pair with none of the model's.
told() {
  python3 -B - "$out/measured/$1" <<'P'
import json, math, sys
name = sys.argv[1]
text = open(name + ".txt", encoding="utf-8").read()
try:
    c = json.load(open(name + "/closure.json", encoding="utf-8"))
except OSError:
    print("none: " + (text.strip().splitlines() or ["no words"])[-1].split(": ", 2)[-1])
    sys.exit()
rms = lambda key, of: math.sqrt(sum(m[of] ** 2 for m in c[key] if m[of] is not None) / max(1, sum(m[of] is not None for m in c[key])))
macs = {key: [m["mac"] for m in c[key] if m.get("mac") is not None] for key in ("modes_before", "modes_after")}
n = sum(m["error_percent"] is not None for m in c["modes_before"])
words = f"{rms('modes_before', 'error_percent'):.2f} -> {rms('modes_after', 'error_percent'):.2f} % rms of {n} modes"
if macs["modes_before"]:
    words += f", least MAC {min(macs['modes_before']):.4f} -> {min(macs['modes_after']):.4f}"
words += "; named: " + ("; ".join(f"{e['effect']} (held out {e['heldout_before']:.2f} -> {e['heldout_after']:.2f} %"
    + (", or " + ", ".join(e["rivals"]) if e["rivals"] else "") + ")" for e in c["steps"]) or "nothing")
for line in text.splitlines():
    if line.startswith("modes of ") and " none of the model's is: " in line:
        words += "; not among the model's modes: " + line.split(": ")[-1]
print(words)
P
}

# after NAME: the rms error after the loop in %, or "none".
after() {
  python3 -B - "$out/measured/$1/closure.json" <<'P' 2>/dev/null || echo none
import json, math, sys
errors = [m["error_percent"] for m in json.load(open(sys.argv[1], encoding="utf-8"))["modes_after"] if m["error_percent"] is not None]
print(f"{math.sqrt(sum(e * e for e in errors) / len(errors)):.2f}")
P
}

measured_line() { # NAME WORDS: errors before and after, or MISS where the loop gives no answer
  local text
  text=$(told "$1")
  line "5.$1" "$([ "${text#none}" = "$text" ] && echo beside || echo MISS)" "$text" "error before and after" "$2"
}

table_of() { printf '%s\n' frequency_hz "${@:2}" >"$out/measured/$1.csv"; } # NAME HZ...

measured_frames() {
  table_of paper 1.657 5.04 8.14 10.83 12.93 14.34
  loop paper "$out/measured/paper.csv" <<<"{kind: shear_frame, storeys: 6}"
  measured_line paper "the paper's six frequencies, uniform shear frame"
  loop paper_places "$out/measured/paper.csv" <<<"{kind: shear_frame, locate: true, masses: [1, 1, 1, 1, 1, 1]}"
  measured_line paper_places "the same, storeys and floors as places"

  if [ -d "$data/mini_shake_table" ]; then
    quietly "$bin/hovermodal" identify --series "$data/mini_shake_table/flexible_northridge.csv" --input ground_m_s2 --max-frequency 24 \
      --report "$out/measured/shake_modes"
    loop shake_table "$out/measured/shake_modes/modal.json" <<<"{kind: shear_frame, storeys: 3, floors: [floor1_m_s2, floor2_m_s2, floor3_m_s2]}"
    measured_line shake_table "three-storey frame on a shake table, frequencies and shapes"
  else
    line 5.shake_table SKIP "no data at $data/mini_shake_table" "error before and after" "three-storey frame on a shake table"
  fi

  if [ -d "$data/knex_frame_video" ]; then
    knex_config >"$out/measured/knex_film.yaml"
    quietly "$bin/hovermodald" --config "$out/measured/knex_film.yaml" --set closure.adopt=off --report "$out/measured/knex_modes"
    loop knex "$out/measured/knex_modes/modal.json" <<<"{kind: shear_frame, storeys: 3, floors: [floor1, floor2, roof]}"
    measured_line knex "three-storey K'nex frame, filmed at 20 frames/s"
  else
    line 5.knex SKIP "no data at $data/knex_frame_video" "error before and after" "three-storey K'nex frame"
  fi
}

# The directions of bending are those in which the roof's reference accelerometers move; torsion moves both alike.
measured_five() {
  local frame=$data/five_storey_frame axis
  if [ ! -d "$frame" ]; then
    line 5.five_storeys SKIP "no data at $frame" "error before and after" "five-storey frame, four set-ups with moved sensors"
    return
  fi
  quietly "$bin/hovermodal" identify --series "$frame"/setup_{01,04,07,10}.csv --rate 256 --channels 1 2 3 4 5 --max-frequency 14 \
    --reference ref_x_m_s2 ref_y_m_s2 --merge --report "$out/measured/five_modes"
  for axis in x y torsion; do
    python3 -B - "$out/measured/five_modes/modal.json" "$axis" >"$out/measured/five_$axis.csv" <<'P'
import json, sys
report = json.load(open(sys.argv[1], encoding="utf-8"))
print("frequency_hz,sigma_hz")
for mode in report["modes"]:
    x, y = (abs(complex(*mode["shape"][name])) for name in ("ref_x_m_s2", "ref_y_m_s2"))
    share = x / (x + y)
    kind = "x" if share > 0.6 else "y" if share < 0.4 else "torsion"
    if kind == sys.argv[2]:
        print(f"{mode['frequency_hz']},{mode['frequency_std_hz']}")
P
    loop "five_storeys_$axis" "$out/measured/five_$axis.csv" <<<"{kind: shear_frame, storeys: 5}"
    measured_line "five_storeys_$axis" "five-storey frame, four set-ups with moved sensors merged, modes of $axis, frequencies"
  done
}

# Only ratios of frequencies are used: neither length nor section is known independently.
measured_beam() {
  local beam=$data/ladisk_beam support free clamped springs span="spans: [{length_m: 1, ei_nm2: 1, mass_per_m_kg: 1}]"
  local -A held=([free]="free" [clamped]="rigid" [springs]="1")
  local what="filmed beam, its accelerometer's 37.0 695.6 1897.9 3670.8 Hz"
  table_of beam 37.0 695.6 1897.9 3670.8
  for support in free clamped springs; do
    printf 'kind: beam\n%s\nspring_prior_percent: 100\nsupports: [{displacement: %s, rotation: %s}, {displacement: %s, rotation: free}]\n' "$span" \
      "${held[$support]}" "$([ $support = clamped ] && echo rigid || echo free)" "$([ $support = springs ] && echo 1 || echo free)" |
      loop "beam_$support" "$out/measured/beam.csv"
    measured_line "beam_$support" "$what, $support$([ $support = springs ] && echo ": on two springs, known to a factor of 2" || true)"
  done
  free=$(after beam_free) clamped=$(after beam_clamped) springs=$(after beam_springs)
  judge 5.beam "free on two springs $springs %, free $free %, clamped $clamped % rms of frequency after the loop" \
    "which support explains it, error before and after" "$what" "$free < $clamped && $springs < $clamped"
  if [ -d "$beam" ]; then
    quietly "$bin/hovermodal" identify --series "$beam/camera_displacements_um.csv" --max-frequency 2200 --report "$out/measured/beam_camera"
    # Higher ones are in the film's noise: the accelerometer has none where the film has one at 2470 Hz.
    python3 -B -c '
import json, sys
print("frequency_hz,sigma_hz")
for mode in json.load(open(sys.argv[1], encoding="utf-8"))["modes"]:
    if mode["frequency_hz"] < 2200:
        print(mode["frequency_hz"], mode["frequency_std_hz"], sep=",")' "$out/measured/beam_camera/modal.json" >"$out/measured/beam_camera.csv"
    for support in free clamped; do
      sed 's/^  //; 1d' "$out/measured/beam_$support.yaml" | loop "beam_camera_$support" "$out/measured/beam_camera.csv"
      measured_line "beam_camera_$support" "the same beam's modes below 2200 Hz from its film, $support, frequencies"
    done
  else
    line 5.beam_camera SKIP "no data at $beam" "which support explains it, error before and after" "filmed beam"
  fi
}

figure_5() {
  rm -rf "$out/measured" && mkdir -p "$out/measured"
  measured_frames
  measured_five
  measured_beam
}

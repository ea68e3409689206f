#!/usr/bin/env bash
# Where people run it.
#   tools/figures/platforms.sh [--quick] [--first-seed N] [FIGURE...]     FIGURE: 1_debian12 1_debian13 2 2_debian13
# 3 4 5_debian12 5_debian13 cost (default: all)
# 1_debian12 and 1_debian13 follow README from nothing in a clean root of that system, an hour each.
# 2 runs kernel drivers in a virtual machine (tests/device), some minutes without KVM; 2_debian13 all of cameras.sh in a clean Debian
# 13, two hours.
# 3 receives from GStreamer's RTSP server (Debian: gir1.2-gst-rtsp-server-1.0 python3-gi gstreamer1.0-libav
# gstreamer1.0-plugins-good gstreamer1.0-plugins-ugly); SKIP where it is absent.
# 4 speaks with an autopilot made of MAVLink's own C library, of which a checkout or an archive of its files lies in
# build/beside/c_library_v2 (https://github.com/mavlink/c_library_v2); SKIP where it is absent.
# 5_debian12 and 5_debian13 build the packages of this commit and of a former one (HOVERMODAL_FORMER=COMMIT) in clean roots, install,
# upgrade, remove and purge them, half an hour each.
# cost counts the instructions of a frame (Debian: valgrind), a quarter of an hour.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
. tools/figures/device.sh
. tools/figures/clean_root.sh
. tools/figures/platforms_cameras.sh
. tools/figures/platforms_cost.sh
. tools/figures/platforms_systems.sh
. tools/figures/platforms_packages.sh
take_arguments "tools/figures/platforms.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
all_or_named 1_debian12 1_debian13 2 2_debian13 3 4 5_debian12 5_debian13 cost
draws 1_debian12 1_debian13 3 4 cost
out=build/figures/platforms
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh hovermodal hovermodald capture_check

# --- 3: streams ------------------------------------------------------------------------------------------------------
server=""
serve() { # LOSS VIDEO QUANTIZER
  rm -f "$out/server.txt"
  /usr/bin/python3 tools/figures/platforms_rtsp_server.py "$rtsp_port" "$1" "$2" "$3" >"$out/server.txt" 2>&1 &
  server=$!
  until grep -qs ready "$out/server.txt"; do
    kill -0 "$server" || return 1
    sleep 0.1
  done
}
unserve() {
  kill "$server" 2>/dev/null || true
  wait "$server" 2>/dev/null || true
}
value_of() { awk -F'\t' -v name="$1" '$1 == name { print $2 }' "$out/received.txt"; }
rtsp_port=24950
figure_3() {
  local bar="frames delivered + counted = sent; modes of the clip within 0.3 %" frames=500 seconds=120
  [ -z "$quick" ] || frames=150 seconds=60
  if ! /usr/bin/python3 -c 'import gi; gi.require_version("GstRtspServer", "1.0")' 2>/dev/null; then
    line 3 SKIP "no GStreamer RTSP server" "$bar" "RTSP on the loopback"
    return
  fi
  local loss transport args
  for transport in tcp udp; do
    for loss in 0 0.01 0.05; do
      [ "$transport" = udp ] || [ "$loss" = 0 ] || continue # inside a connection what is lost is sent again, by the kernel
      args=()
      [ "$transport" = tcp ] || args=(--udp)
      serve "$loss" numbered 18
      "$bin/capture_check" --driver stream --source "rtsp://127.0.0.1:$rtsp_port/video" "${args[@]}" --numbered --frames "$frames" --limit 60 \
        >"$out/received.txt" 2>/dev/null || true
      unserve
      judge "3.frames_${transport}_$loss" \
        "$(value_of frames) delivered + $(value_of missing) counted = $(value_of span) sent; steps unlike the pictures' numbers $(value_of wrong_numbers), damaged pictures delivered $(value_of damaged_pictures)" \
        "frames delivered + counted = sent" "RTSP over $transport, $loss of the packets lost, pictures that carry their numbers" \
        "$(value_of frames) == $frames && $(value_of frames) + $(value_of missing) == $(value_of span) && $(value_of wrong_numbers) == 0 && $(value_of damaged_pictures) == 0"
    done
  done
  serve 0 numbered 18
  "$bin/capture_check" --driver stream --source "rtsp://127.0.0.1:$rtsp_port/video" --numbered --frames "$frames" --limit 60 >"$out/received.txt" 2>/dev/null &
  local receiver=$!
  sleep 8
  unserve
  sleep 2
  serve 0 numbered 18
  wait "$receiver" || true
  unserve
  judge 3.frames_restart \
    "$(value_of frames) delivered, sender restarted $(value_of restarts) times, interruptions $(value_of interruptions); steps unlike the pictures' numbers $(value_of wrong_numbers), numbers less time $(value_of span) - $(value_of span_by_time)" \
    "with the server restarted: frames delivered + counted = sent" "RTSP over tcp, the server killed for 2 s" \
    "$(value_of frames) == $frames && $(value_of restarts) == 1 && $(value_of interruptions) == 1 && $(value_of wrong_numbers) == 0 && ($(value_of span) - $(value_of span_by_time)) ^ 2 <= 1"
  figure_3_modes "$seconds"
}

# The same film from the file and over the network, where every picture is coded by itself into some ten packets.
figure_3_modes() { # SECONDS
  local film="$out/film" loss transport
  "$bin/hovermodal" simulate --scene tools/scenes/facade.yaml --size 360p --duration "$1" --seed "$first_seed" --crf 10 --out "$film" --quiet
  "$bin/hovermodald" --config "$film/config.yaml" --set telemetry.lcm_url= --report "$out/from_file" >"$out/from_file.txt" 2>&1
  while read -r transport loss; do
    serve "$loss" "$film/clip.mp4" 32
    timeout -s INT "$(($1 + 4))" "$bin/hovermodald" --config "$film/config.yaml" --set camera.driver=stream --set "camera.transport=$transport" \
      --set "camera.source=rtsp://127.0.0.1:$rtsp_port/video" --set telemetry.lcm_url= --report "$out/from_stream" >"$out/from_stream.txt" 2>&1 || true
    unserve
    local found all worst frames missing
    read -r found all worst frames missing < <(python3 - "$out" <<'PY'
import json, sys
def read(name):
    return json.load(open(f"{sys.argv[1]}/{name}/modal.json"))
of_file, of_stream = read("from_file"), read("from_stream")
errors = []
for mode in of_file["modes"]:
    near = min((abs(m["frequency_hz"] / mode["frequency_hz"] - 1) for m in of_stream["modes"]), default=1)
    if near < 0.02:
        errors.append(100 * near)
print(len(errors), len(of_file["modes"]), f"{max(errors, default=100):.3f}", of_stream["losses"]["frames_in"], of_stream["losses"]["frames_missing"])
PY
    )
    judge "3.modes_${transport}_$loss" "$found of the $all modes of the file, off by $worst % at most; $frames frames, $missing missing" \
      "modes of the clip within 0.3 %" "RTSP over $transport, $loss of the packets lost, $1 s, $(seeds_of 1)" "$found == $all && $worst <= 0.3"
  done <<<"tcp 0
udp 0.01
udp 0.05"
}

# --- 4: MAVLink ------------------------------------------------------------------------------------------------------
# A rotor shakes the camera at a rate that the samples show between 0.7 and 11.8 Hz. The autopilot states that of four motors.
figure_4_rotor() {
  local n=20 seconds=12 i pids=()
  [ -z "$quick" ] || n=3
  python3 - "$out" "$first_seed" "$n" <<'PY'
import random, sys
out, first, n = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
for i in range(n):
    draw = random.Random(first + i)
    while True:
        hz, rate = draw.uniform(70, 130), draw.uniform(24, 30)
        shown = abs((hz + rate / 2) % rate - rate / 2)
        if 0.7 < shown < min(11.8, rate / 2 - 0.7):
            break
    spread = draw.uniform(0.005, 0.03)
    with open(f"{out}/rotor_{i}.yaml", "w") as scene:
        scene.write(f"preset: paper\nseed: {first + i}\nduration_s: 120\ncamera: {{rate_hz: {rate:.3f}}}\n"
                    f"rotor: {{frequency_hz: {hz:.4f}, wander_rms_hz: {spread:.4f}, pitch_rms_mdeg: {draw.uniform(2, 6):.2f}, "
                    f"yaw_rms_mdeg: {draw.uniform(2, 6):.2f}, roll_rms_mdeg: {draw.uniform(2, 6):.2f}}}\n")
    with open(f"{out}/rotor_{i}.txt", "w") as drawn:
        drawn.write(f"{hz:.4f} {spread:.4f} {shown:.4f}\n")
PY
  local hz spread
  for ((i = 0; i < n; i++)); do
    read -r hz spread _ <"$out/rotor_$i.txt"
    "$bin/hovermodal" mavlink --link "udpin:127.0.0.1:$((24950 + i))" --channel "ROTOR_$i" --seconds "$seconds" --motors "$out/motors_$i.csv" --quiet &
    pids+=($!)
    "$out/autopilot" motors "$((24950 + i))" "$((first_seed + i))" "$seconds" "$hz" "$spread" &
    pids+=($!)
  done
  wait "${pids[@]}" || true
  for ((i = 0; i < n; i++)); do
    "$bin/hovermodal" simulate --scene "$out/rotor_$i.yaml" --tracks-only --out "$out/rotor_$i" --force --quiet
    "$bin/hovermodal" replay --tracks "$out/rotor_$i/tracks.csv" --config "$out/rotor_$i/config.yaml" --set "camera.motors_file=$PWD/$out/motors_$i.csv" --report "$out/rotor_$i/identified" --quiet || true
    "$bin/hovermodal" closeloop --record "$out/rotor_$i/tracks.csv" --config "$out/rotor_$i/config.yaml" --set "camera.motors_file=$PWD/$out/motors_$i.csv" --report "$out/rotor_$i/loop" --quiet || true
  done
  local named verdicts
  read -r named verdicts < <(python3 - "$out" "$n" <<'PY'
import json, sys
out, n = sys.argv[1], int(sys.argv[2])
named = verdicts = 0
for i in range(n):
    shown = float(open(f"{out}/rotor_{i}.txt").read().split()[2])
    loop = json.load(open(f"{out}/rotor_{i}/loop/closure.json"))
    lines = [s for s in loop["steps"] if s["effect"] == "rotor line"]
    named += len(lines) > 0 and all("motor 3" in s["meaning"] for s in lines)
    modal = json.load(open(f"{out}/rotor_{i}/identified/modal.json"))
    verdicts += not any(abs(m["apparent_hz"] - shown) < 0.02 and "motor 3" not in m["reason"] for m in modal["modes"])
print(named, verdicts)
PY
  )
  judge 4.rotor "$named of $n by the loop; no mode at the line without its motor in $verdicts of $n" "rotor line named by its rpm" \
    "simulated flights of 120 s, the camera shaken by one of four motors whose speeds came over MAVLink, $(seeds_of "$n")" "$named == $n && $verdicts == $n"
}

figure_4() {
  local library=build/beside/c_library_v2 port=24900 packets=100000 noise=1000000 links=20 seconds=30
  [ -z "$quick" ] || packets=10000 noise=100000 links=3 seconds=15
  if [ ! -f "$library/ardupilotmega/mavlink.h" ]; then
    line 4 SKIP "no $library" "parsed = sent; clock offset found within 2 ms; rotor line named by its rpm" "MAVLink beside its own C library"
    return
  fi
  g++ -std=c++20 -O1 -w -isystem "$library" -o "$out/autopilot" tools/figures/platforms_autopilot.cpp
  local sent read wrong status=0
  "$out/autopilot" stream "$port" "$first_seed" "$packets" "$noise" >"$out/sent.txt" &
  sleep 3
  timeout 120 "$bin/hovermodal" mavlink --link "tcp:127.0.0.1:$port" --seconds 20 --json --quiet >"$out/stream.json" || status=$?
  wait
  read -r sent _ <"$out/sent.txt"
  read -r read wrong < <(python3 -c '
import json, sys
d = json.load(open(sys.argv[1]))
print(d["messages"], d["wrong_checksums"])' "$out/stream.json")
  judge 4.parsed "$read of $sent packets between $noise bytes of noise read, $wrong false starts refused, exit status $status" \
    "10^6 fuzzed bytes and 10^5 packets, parsed = sent, none crash" "packets of ten kinds, written by MAVLink's C library, over TCP, seed $first_seed" \
    "$read == $sent && $status == 0"
  local i pids=()
  for ((i = 0; i < links; i++)); do
    "$bin/hovermodal" mavlink --link "udpin:127.0.0.1:$((port + 1 + i))" --channel "ATTITUDE_$i" --seconds "$seconds" --json --quiet >"$out/clock_$i.json" &
    pids+=($!)
    "$out/autopilot" clock "$((port + 1 + i))" "$((first_seed + i))" "$seconds" 50 20 >"$out/clock_$i.txt" &
    pids+=($!)
  done
  wait "${pids[@]}" || true
  local worst sigmas attitudes found
  read -r found worst sigmas attitudes < <(python3 - "$out" "$links" <<'PY'
import json, sys
out, links = sys.argv[1], int(sys.argv[2])
errors, scaled, attitudes = [], [], []
for i in range(links):
    d = json.load(open(f"{out}/clock_{i}.json"))
    ahead, drift = map(float, open(f"{out}/clock_{i}.txt").read().split())
    if "clock" not in d:
        continue
    c = d["clock"]
    error = c["offset_ns"] - (ahead + drift * c["at_ns"])
    errors.append(abs(error) * 1e-6)
    scaled.append(abs(error) / c["sigma_ns"])
    attitudes.append(d["attitudes"])
print(len(errors), f"{max(errors):.3f}", f"{max(scaled):.2f}", min(attitudes))
PY
  )
  judge 4.clock "off by $worst ms at most ($sigmas of its sigma), in $found of $links links; at least $attitudes attitudes handed on" \
    "attitude over a link with 50 ms delay and 20 ms jitter: clock offset found within 2 ms" \
    "delays each way, drift 30 ppm, $seconds s, $(seeds_of "$links")" "$worst <= 2 && $found == $links"
  figure_4_rotor
}

run_figures "${figures[@]}"

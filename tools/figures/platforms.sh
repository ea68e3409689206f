#!/usr/bin/env bash
# Where people run it.
#   tools/figures/platforms.sh [--quick] [--first-seed N] [FIGURE...]     FIGURE: 4 (default: all)
# 4 speaks with an autopilot made of MAVLink's own C library, of which a checkout or an archive of its files lies in
# build/beside/c_library_v2 (https://github.com/mavlink/c_library_v2); SKIP where it is absent.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/platforms.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
all_or_named 4
draws 4
out=build/figures/platforms
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh hovermodal

# --- 4: MAVLink ------------------------------------------------------------------------------------------------------
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
  line 4.rotor MISS "not built: motor speeds are read and stated, not handed to verdicts and loop" "rotor line named by its rpm" "rotor lines at the motors' frequencies"
}

run_figures "${figures[@]}"

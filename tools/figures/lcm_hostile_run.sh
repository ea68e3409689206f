#!/usr/bin/env bash
# Malformed datagrams at every subscriber of ours at once; result.txt begins with "ok" or "bad".
# Run it in a network of its own (tools/figures/ground_link.sh does): tools/figures/lcm_hostile_run.sh CLIP_FOLDER OUT N SEED
set -euo pipefail
cd "$(dirname "$0")/../.."
bin=build/release/bin clip=$1 out=$2 n=$3 seed=$4 url="udpm://239.255.76.72:7672?ttl=0"
mkdir -p "$out"
rm -f "$out"/*
trap 'kill $(jobs -p) 2>/dev/null || true' EXIT # otherwise listeners would run on for an hour if this script ends early
ip link set lo up
ip route add 224.0.0.0/4 dev lo

wait_for() { for _ in $(seq 100); do grep -q "listening on" "$out/$1.log" && break; sleep 0.1; done; }
alive=""
note_alive() { local name; for name in "$@"; do kill -0 "${!name}" 2>/dev/null && alive+=" $name"; done; }
"$bin/hovermodal" spy --url "$url" --plain --seconds 3600 --count "$out/spy.json" >"$out/spy.log" 2>&1 &
spy=$!
"$bin/hovermodal" inspect --url "$url" --plain --seconds 3600 --count "$out/inspect.json" >"$out/inspect.log" 2>&1 &
inspect=$!
"$bin/subscribe" --url "$url" --seconds 3600 >"$out/subscribe.log" 2>&1 &
subscribe=$!
start_python() {
  python3 tools/examples/subscribe.py --url "$url" --seconds 3600 >"$out/$1.log" 2>&1 &
  eval "$1=$!"
  wait_for "$1"
}
# At five frames a second the clip lasts longer than all that is sent.
"$bin/hovermodald" --config "$clip/config.yaml" --set camera.pace=realtime --set camera.rate_hz=5 --set camera.attitude_channel=ATTITUDE --set scale.only=false \
  --set "telemetry.lcm_url=$url" --set telemetry.channel_prefix=OTHER --set "telemetry.log_file=$out/service.lcm" >"$out/service.log" 2>&1 &
service=$!
for name in spy inspect subscribe; do wait_for $name; done
start_python python
sleep 3
# Messages first. LCM's own library, used by the C++ example, would not survive the datagrams that follow.
"$bin/lcm_hostile" send "$seed" "$url" $((n * 8 / 10)) 5000 messages >"$out/sent.txt"
sleep 1
note_alive spy inspect subscribe python service
"$bin/lcm_hostile" end "$url" # well-formed: listeners that wait for the end then end
start_python python2
"$bin/lcm_hostile" send "$seed" "$url" $((n - n * 8 / 10)) 5000 datagrams >>"$out/sent.txt"
sleep 1
note_alive spy inspect python2 service
"$bin/lcm_hostile" end "$url"
kill -INT $spy $inspect $service 2>/dev/null || true
codes=""
for name in spy inspect subscribe python python2 service; do
  code=0
  timeout 30 tail --pid="${!name}" -f /dev/null || { kill -KILL "${!name}"; }
  wait "${!name}" || code=$?
  codes+=" $name $code"
done
counted() { python3 -c 'import json, sys; c = json.load(open(sys.argv[1]))["channels"]; print(sum(v["received"] + v["foreign"] for v in c.values()), sum(v["undecodable"] for v in c.values()))' "$1" 2>/dev/null || echo "0 0"; }
read -r spy_read spy_refused < <(counted "$out/spy.json")
attitude=$(python3 tools/figures/lcm_log.py final "$out/service.lcm" build/release/python |
  python3 -c 'import json, re, sys; print(*[w for w in json.load(sys.stdin)["warnings"] if "attitude_channel" in w])')
verdict=bad
if [ "$alive" = " spy inspect subscribe python service spy inspect python2 service" ] &&
  [ "$codes" = " spy 0 inspect 0 subscribe 0 python 0 python2 0 service 0" ] && [ "$spy_refused" -gt 0 ] && [[ "$attitude" =~ [1-9][0-9]*" messages are not an attitude" ]]; then verdict=ok; fi
echo "$verdict $(tr '\n' ' ' <"$out/sent.txt"); exit codes:$codes; spy read $spy_read, refused $spy_refused; C++ example: $(tail -n 1 "$out/subscribe.log"); Python: $(tail -n 1 "$out/python.log"); service: $attitude" >"$out/result.txt"

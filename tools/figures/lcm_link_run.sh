#!/usr/bin/env bash
# The service on one side of a bad radio link, spy and lcm-logger on the other: network namespaces joined by veth, with
# 20 % loss, 100 ms delay and 256 kbit/s by `tc netem`, or where the kernel has none by link_relay.py.
#   tools/figures/lcm_link_run.sh CLIP_FOLDER OUT MAX_KBIT_S SEED      as root; writes spy.json, ground.lcm, run.lcm, rate.txt, how.txt
set -euo pipefail
cd "$(dirname "$0")/../.."
bin=build/release/bin clip=$1 out=$2 cap=$3 seed=$4
url="udpm://239.255.76.72:7672?ttl=1"
sky=hm_sky_$$ radio=hm_radio_$$ ground=hm_ground_$$
mkdir -p "$out"
rm -rf "$out"/*.json "$out"/*.lcm* "$out"/*.txt "$out"/*.log "$out/report"
started=()
cleanup() {
  local id
  for id in "${started[@]}"; do kill "$id" 2>/dev/null || true; done
  for id in $sky $radio $ground; do ip netns del "$id" 2>/dev/null || true; done
}
trap cleanup EXIT
in_sky() { ip netns exec $sky "$@"; }
in_ground() { ip netns exec $ground "$@"; }

for place in $sky $radio $ground; do
  ip netns add $place
  ip netns exec $place sysctl -qw net.ipv6.conf.default.disable_ipv6=1 2>/dev/null || true
done
# attach NAMESPACE ADDRESS: the interface `air` of a side is up and takes multicast
attach() {
  ip -n "$1" link set lo up
  ip -n "$1" address add "$2/24" dev air
  ip -n "$1" link set air up
  ip -n "$1" route add 224.0.0.0/4 dev air
}
ip link add air netns $sky type veth peer name air netns $ground
attach $sky 10.77.0.1
attach $ground 10.77.0.2
if in_sky tc qdisc add dev air root netem loss 20% delay 100ms rate 256kbit limit 100 2>/dev/null; then
  in_ground tc qdisc add dev air root netem loss 20% delay 100ms rate 256kbit limit 100
  echo "tc netem" >"$out/how.txt"
else
  ip -n $sky link del air
  ip link add air netns $sky type veth peer name to_sky netns $radio
  ip link add air netns $ground type veth peer name to_ground netns $radio
  ip -n $radio link set to_sky up
  ip -n $radio link set to_ground up
  attach $sky 10.77.0.1
  attach $ground 10.77.0.2
  ip netns exec $radio python3 tools/figures/link_relay.py to_sky to_ground --loss 0.2 --delay-ms 100 --kbit-s 256 --seed "$seed" --count "$out/relay.json" \
    >"$out/relay.log" 2>&1 &
  relay=$!
  started+=($relay)
  for _ in $(seq 100); do grep -q carrying "$out/relay.log" && break; sleep 0.1; done
  echo "a relay in user space between two veth pairs (this kernel has no sch_netem)" >"$out/how.txt"
fi

ip netns exec $ground lcm-logger -q --lcm-url="$url" "$out/ground.lcm" >"$out/logger.log" 2>&1 &
logger=$!
ip netns exec $ground "$bin/hovermodal" spy --url "$url" --plain --seconds 600 --count "$out/spy.json" >"$out/spy.log" 2>&1 &
spy=$!
started+=($logger $spy)
for _ in $(seq 100); do grep -q "listening on" "$out/spy.log" && break; sleep 0.1; done
# Bytes sent, once a second.
ip netns exec $sky bash -c 'while sleep 1; do ip -s -j link show air; echo; done' >"$out/rate.jsonl" 2>/dev/null &
rate=$!
started+=($rate)
code=0
in_sky "$bin/hovermodald" --config "$clip/config.yaml" --set camera.pace=realtime --set "telemetry.lcm_url=$url" --set telemetry.max_kbit_s="$cap" --set telemetry.tracks_every=1 --set identification.period=1 \
  --set "telemetry.log_file=$out/run.lcm" --report "$out/report" >"$out/service.log" 2>&1 || code=$?
sleep 2
kill -INT $spy && wait $spy || true  # its own signal handler writes the counts
kill $logger $rate || true
[ -z "${relay:-}" ] || { kill $relay && wait $relay || true; }
echo $code >"$out/exit.txt"

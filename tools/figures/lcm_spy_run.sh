#!/usr/bin/env bash
# lcm-spy on a screen that nobody sees, while a log is played: its list, its windows and a picture.
# Run it in a network of its own (tools/figures/ground_link.sh does): tools/figures/lcm_spy_run.sh LOG OUT
set -euo pipefail
cd "$(dirname "$0")/../.."
log=$1 out=$2 url="udpm://239.255.76.72:7672?ttl=0"
java=/usr/share/java path=build/release/hovermodal_lcm.jar:$out/classes
for library in lcm jchart2d xmlgraphics-commons; do path+=:$java/$library.jar; done
ip link set lo up
ip route add 224.0.0.0/4 dev lo
rm -f "$out/lcm_spy.png" "$out/lcm_spy.txt" "$out/display"
Xvfb -displayfd 3 -screen 0 1600x2040x24 -nolisten tcp 3>"$out/display" 2>"$out/xvfb.log" &
xvfb=$!
trap 'kill $xvfb $player 2>/dev/null || true' EXIT
player=
for _ in $(seq 100); do [ -s "$out/display" ] && break; sleep 0.1; done
(sleep 4; while lcm-logplayer --lcm-url="$url" --speed=2 "$log" >/dev/null 2>&1; do :; done) &
player=$!
DISPLAY=:$(cat "$out/display") timeout 180 java -Djava.net.preferIPv4Stack=true -Xmx512m -cp "$path" LcmSpyCheck spy "$url" 40 "$out/lcm_spy.png" \
  >"$out/lcm_spy.txt" 2>"$out/lcm_spy.log"

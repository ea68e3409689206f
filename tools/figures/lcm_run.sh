#!/usr/bin/env bash
# One run heard by a second process over LCM, and its log replayed: writes live.txt and log.txt, "ok ..." or "bad ...".
# Run it in a network of its own (tools/figures/main_job.sh does): tools/figures/lcm_run.sh CLIP_FOLDER OUT
set -euo pipefail
cd "$(dirname "$0")/../.."
bin=build/release/bin clip=$1 out=$2
url="udpm://239.255.76.67:7667?ttl=0"
mkdir -p "$out"
rm -f "$out"/*.txt "$out"/*.json "$out"/*.log

# hear NAME COMMAND...: the spy counts while COMMAND runs.
hear() {
  local name=$1
  shift
  "$bin/hovermodal" spy --url "$url" --plain --once --seconds 300 --count "$out/$name.json" >"$out/$name.spy.log" 2>&1 &
  local spy=$!
  for _ in $(seq 100); do grep -q "listening on" "$out/$name.spy.log" && break; sleep 0.1; done
  "$@" >"$out/$name.run.log" 2>&1 || { echo "bad the run failed: $(tail -n 1 "$out/$name.run.log")" >"$out/$name.txt"; kill $spy; return 1; }
  wait $spy || { echo "bad the spy ended without a final health message" >"$out/$name.txt"; return 1; }
  # "complete" is reported by the spy: every channel received what the final health states as sent, without a gap.
  awk '/"complete"/ { complete = /true/ } /"received"/ { gsub(/[^0-9]/, ""); n += $0; channels++ } /"gaps"/ { gsub(/[^0-9]/, ""); gaps += $0 }
       END { printf "%s %d messages on %d channels, %d gaps", complete && gaps == 0 ? "ok" : "bad", n, channels, gaps }' "$out/$name.json" >"$out/$name.txt"
}

hear live "$bin/hovermodald" --config "$clip/config.yaml" --set "telemetry.lcm_url=$url" --set "telemetry.log_file=$out/run.log"
hear log lcm-logplayer --lcm-url="$url" --speed=8 "$out/run.log"

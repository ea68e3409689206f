#!/usr/bin/env bash
# The service with report, record and state on a disk of its own (guest.sh --disk), run after run. Says on standard output
# what a loss of power must leave from then on; tests/device/power_cuts.py cuts the power afterwards, in what reached the disk.
#   power.sh RUNS CONFIG [KEY=VALUE...]
set -euo pipefail
bin=${HOVERMODAL_BIN:-build/release/bin}
runs=$1 config=$2
shift 2
keys=()
for key in "$@" report.directory=/flight/report record.directory=/flight/records state.directory=/flight/state; do keys+=(--set "$key"); done
modprobe -a virtio_blk ext4
mkdir -p /flight
mount -t ext4 /dev/vda /flight
for ((run = 1; run <= runs; run++)); do
  rm -rf /flight/state # as after a flight of its own
  "$bin/hovermodald" --config "$config" "${keys[@]}" >"/out/run_$run.txt" 2>&1 &
  service=$!
  while sleep 1 && kill -0 $service 2>/dev/null; do
    now=$(cut -d' ' -f1 /proc/uptime) state=0 bytes=0
    [ ! -e /flight/state/hovermodal.state ] || state=1
    for file in /flight/records/*run*"$run"_*.lcm; do [ ! -e "$file" ] || bytes=$((bytes + $(stat -c %s "$file"))); done
    sleep 0.5 # what was seen of the state is on the disk
    echo "run $run at $now s: state $state, record $bytes bytes"
  done
  status=0
  wait $service || status=$?
  echo "run $run ended with $status"
  cp -r /flight/report "/out/report_$run"
done
cp -r /flight/records /out/records

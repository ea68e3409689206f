#!/usr/bin/env bash
# From a frame's stamp to the capturing thread having it, under load, with ordinary scheduling and with real-time
# settings. In virtual time (guest.sh --icount): a comparison of kernels and settings, never a board's latency.
. tests/device/cases/lib.sh
vivid
v4l2-ctl -d /dev/video0 --set-input=3 >/dev/null 2>&1
v4l2-ctl -d /dev/video0 --set-dv-bt-timings=index=0 >/dev/null 2>&1
load() {
  while :; do dd if=/dev/zero of=/run/x bs=4M count=4; done >/dev/null 2>&1 &
  while :; do find /usr/share/doc -type f; done >/dev/null 2>&1 &
  hackbench -g 2 -l 1000000 >/dev/null 2>&1 &
}
how=(--source /dev/video0 --size 320x180 --format GREY --frames "${FRAMES:-300}" --limit 60)
load
capture ordinary "${how[@]}"
# The kernel thread that makes vivid's frames, as one would do with a device's interrupt thread.
raise() {
  is_streaming realtime
  for pid in $(pgrep vivid); do chrt -f -p 85 "$pid"; done
}
raise &
capture realtime "${how[@]}" --fifo 80
for name in ordinary realtime; do
  printf 'figure\t%s, %s\t%s\t%s\t%s\t%s\n' "$(uname -v | grep -o 'PREEMPT[A-Z_]*')" $name "$(fact $name age_p50_ms)" "$(fact $name age_p99_ms)" "$(fact $name worst_age_ms)" "$(fact $name frames)"
done
pkill hackbench
judge "latency: all frames came" "$(fact ordinary frames) and $(fact realtime frames)" "${FRAMES:-300} each" "$(fact ordinary frames)+0 == ${FRAMES:-300} && $(fact realtime frames)+0 == ${FRAMES:-300}"
finish

#!/usr/bin/env bash
# How late the capturing thread runs for a frame, under load, with ordinary scheduling and with real-time settings: by the
# kernel's own trace, from its waking the thread that makes vivid's frame until ours runs, less the least (that is the
# frame's making); where that thread did not sleep, being late itself, from its waking ours. In virtual time (guest.sh --icount): a comparison of kernels and settings, never a board's latency.
. tests/device/cases/lib.sh
tracing=/sys/kernel/tracing
vivid
v4l2-ctl -d /dev/video0 --set-input=3 >/dev/null 2>&1
v4l2-ctl -d /dev/video0 --set-dv-bt-timings=index=0 >/dev/null 2>&1
mount -t tracefs tracing $tracing
echo 8192 >$tracing/buffer_size_kb
echo 'comm ~ "vivid*" || comm == "capture_check"' >$tracing/events/sched/sched_waking/filter
echo 'next_comm == "capture_check"' >$tracing/events/sched/sched_switch/filter
echo 1 >$tracing/events/sched/sched_waking/enable
echo 1 >$tracing/events/sched/sched_switch/enable

# The load comes once frames do: a program that starts among eighty others takes minutes of such time.
load() { # NAME
  local made_by=0
  wait_for 2000 grep -q streaming "/out/$1.err" # idle waiting takes long in virtual time
  # The kernel threads that make vivid's frames, in both runs alike: as a device's interrupt thread is by itself. What
  # differs between the runs is the settings of our thread alone. vivid starts them with each stream.
  for pid in $(pgrep vivid); do chrt -f -p 85 "$pid" && made_by=$((made_by + 1)); done
  echo "$made_by" >"/out/$1.made_by"
  while :; do dd if=/dev/zero of=/run/x bs=8M count=8; done >/dev/null 2>&1 &
  while :; do find /usr/share/doc /sys/devices; done >/dev/null 2>&1 &
  hackbench -g 4 -l 1000000 >/dev/null 2>&1 &
  : >$tracing/trace
  wait
}
# Waking of vivid's thread -> it wakes ours -> ours runs: a line for each, "whole" or "part", milliseconds.
lateness() {
  awk '{
    for (i = 1; i <= NF && $i !~ /^[0-9]+\.[0-9]+:$/; i++) continue
    t = $i + 0
    if ($(i + 1) == "sched_switch:" && made) { printf "%s %.3f\n", kind, 1e3 * (t - made); made = 0 }
    if ($(i + 1) != "sched_waking:") next
    if (/waking: comm=vivid/) { if (!begun) begun = t; next }
    if ($1 ~ /^vivid/) { made = begun ? begun : t; kind = begun ? "whole" : "part"; begun = 0 }
  }' $tracing/trace
}
under_load() { # NAME SECONDS ARG...
  local name=$1 limit_s=$2 loading
  shift 2
  set -m
  load "$name" &
  loading=$!
  set +m
  capture "$name" "$@" --source /dev/video0 --size 320x180 --format GREY --frames "${FRAMES:-1000}" --limit "$limit_s"
  kill -9 -- -$loading
  pkill -9 hackbench
  wait 2>/dev/null
  lateness >"/out/$name.lateness"
}
under_load ordinary 10
under_load realtime 60 --fifo 80
least=$(awk '$1 == "whole" { print $2 }' /out/*.lateness | sort -g | head -1)
late() { # NAME SHARE
  awk -v least="$least" '{ print $1 == "whole" ? $2 - least : $2 }' "/out/$1.lateness" | sort -g |
    awk -v share="$2" '{ t[NR] = $1 } END { printf "%.3f", t[int(share * (NR - 1)) + 1] }'
}
for name in ordinary realtime; do
  printf 'figure\t%s, %s\t%s\t%s\t%s\t%s\n' "$(uname -v | grep -o 'PREEMPT[A-Z_]*')" $name "$(late $name 0.5)" "$(late $name 0.99)" "$(late $name 1)" "$(fact $name frames) of $(fact $name span)"
done
judge "latency: frames with real-time settings" "$(fact realtime frames), $(fact realtime missing) missing; ordinary $(fact ordinary frames), $(fact ordinary missing) missing" "${FRAMES:-1000}, at most 1 % missing, fewer than without" \
  "$(fact realtime frames)+0 == ${FRAMES:-1000} && $(fact realtime missing)+0 <= 0.01 * ${FRAMES:-1000} && $(fact realtime missing)+0 < $(fact ordinary missing)+0"
judge "latency: threads that make the frames, at the same priority in both runs" "$(cat /out/ordinary.made_by) ordinary, $(cat /out/realtime.made_by) with real-time settings" "as many in both, at least one" \
  "$(cat /out/ordinary.made_by)+0 > 0 && $(cat /out/ordinary.made_by)+0 == $(cat /out/realtime.made_by)+0"
judge "latency: what the kernel traced" "$(wc -l </out/ordinary.lateness) ordinary, $(wc -l </out/realtime.lateness) with real-time settings" "2 of 3 frames with" \
  "$(wc -l </out/realtime.lateness) >= ${FRAMES:-1000} * 2 / 3"
finish

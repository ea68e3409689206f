#!/bin/bash
# The installed service under Debian's own systemd, on a kernel test camera: ready, real-time, hung, crashed, stopped. Runs
# in the machine of `guest.sh --root DIR`, DIR a Debian with the packages; /out holds this file, lib.sh and hold_thread.
. /out/lib.sh
unit=hovermodald
property() { systemctl show "$unit" -p "$1" --value; }
is() { [ "$(property "$1")" = "$2" ]; }
journal() { journalctl -u "$unit" -o cat --no-pager; }
said() { journal | grep -cE "$1"; }
now_ms() { awk '{ print int(1000 * $1) }' /proc/uptime; }

# A picture with corners that keeps still; few points and a low rate, so that an emulated CPU can follow.
modprobe vivid n_devs=1
wait_for 60 test -c /dev/video0
udevadm settle -t 30
v4l2-ctl -d /dev/video0 -c test_pattern=4 >/dev/null
cat >/etc/hovermodal/hovermodald.yaml <<'Y'
camera: {driver: v4l2, source: /dev/video0, size: [640, 360], rate_hz: 5}
regions:
  - {name: base, rect: [40, 200, 240, 100], role: base}
  - {name: top, rect: [340, 200, 240, 100]}
tracking: {points_per_region: 6}
spectrum: {segment: 16}
closure: {adopt: "off"}
telemetry: {preview_period_s: 0}
report: {directory: report}
record: {directory: records, file_mb: 10, quota_mb: 100}
state: {directory: state, period_s: 2}
rt: {required: true, priority: 50, lock_memory: true, stall_s: 5, thin_overload: false}
Y
# Loading the libraries alone takes an emulated CPU a minute.
mkdir -p /run/systemd/system/$unit.service.d
printf '[Service]\nTimeoutStartSec=600\n' >/run/systemd/system/$unit.service.d/emulated.conf
systemctl daemon-reload
# The device's group is Debian's own rule; the service's user must be in it.
group=$(stat -c %G /dev/video0)

states=
systemctl enable --now --no-block $unit
for ((i = 0; i < 4000; i++)); do
  state="$(property ActiveState)/$(property SubState)"
  [ "${states##* }" = "$state" ] || states+=" $state"
  case $state in active/running | failed/*) break ;; esac
  sleep 0.1
done
seen_when_active=$(said 'v4l2|vivid')
judge "started: active only when it has said that it is ready" "states$states, status '$(property StatusText)', camera of group $group" "activating, then active; running" \
  "\"$states\" ~ /activating\\/start.*active\\/running/ && \"$(property StatusText)\" == \"running\" && $seen_when_active > 0"
# What is to be seen afterwards, whatever comes.
keep() {
  journalctl -u "$unit" --no-pager -o short-monotonic
  systemctl status "$unit" --no-pager
} >/out/journal.txt 2>&1
is ActiveState active || { keep; finish; }

pid=$(property MainPID)
user=$(stat -c %U "/proc/$pid")
capabilities=$(awk '/CapEff/ { print $2 }' "/proc/$pid/status")
filter=$(awk '/^Seccomp:/ { print $2 }' "/proc/$pid/status")
fifo=0
for task in "/proc/$pid/task"/*; do
  case $(cat "$task/comm") in hm-capture | hm-tracking | hm-spectrum) ! chrt -p "${task##*/}" | grep -q SCHED_FIFO || fifo=$((fifo + 1)) ;; esac
done
locked=$(awk '/VmLck/ { print $2 }' "/proc/$pid/status")
judge "inside the sandbox" "user $user, capabilities $capabilities, filter of system calls $filter, $fifo stages SCHED_FIFO, $locked kB locked" "its own user, none, 2, 3, some" \
  "\"$user\" == \"hovermodal\" && \"$capabilities\" == \"0000000000000000\" && $filter == 2 && $fifo == 3 && $locked > 0"

# Some record, then a stage that hangs: held from outside in the middle of its work.
wait_for 120 test -s /var/lib/hovermodal/state/hovermodal.state || ls -la /var/lib/hovermodal/state >&2
sleep 12
began=$(now_ms)
/out/hold_thread "$pid" hm-tracking >/out/held.txt 2>&1 &
wait_for 400 is NRestarts 1
wait_for 400 is ActiveState active
took=$((($(now_ms) - began) / 1000))
judge "a hung stage: restarted by the watchdog" "$(cat /out/held.txt), $(said 'stalled: ') times reported, $(journal | grep -oE 'watchdog timeout|Watchdog timeout' | head -n 1), active again after $took s, goes on with the state: $(said 'goes on with the state')" \
  "told, one restart, state resumed" "$(said 'stalled: ') > 0 && $(property NRestarts) == 1 && $(said '[Ww]atchdog timeout') > 0 && $(said 'goes on with the state') == 1"

pid=$(property MainPID)
sleep 12
began=$(now_ms)
kill -SEGV "$pid"
wait_for 400 is NRestarts 2
wait_for 400 is ActiveState active
judge "a crash: restarted, goes on from the checkpoint" "active again after $((($(now_ms) - began) / 1000)) s; $(journal | grep -oE 'goes on with the state.*' | tail -n 1)" \
  "one more restart, state resumed" "$(property NRestarts) == 2 && $(said 'goes on with the state') == 2 && \"$(property ActiveState)\" == \"active\""

sleep 8
began=$(now_ms)
systemctl stop $unit
took=$(($(now_ms) - began))
left=$(cd /var/lib/hovermodal && ls report/modal.json records/*.lcm 2>/dev/null | wc -l)
judge "stopped" "$took ms, result $(property Result), status $(property ExecMainStatus), $left of report and records there" "within 30 s, success, 0, report and record" \
  "$took < 30000 && \"$(property Result)\" == \"success\" && $(property ExecMainStatus) == 0 && $left >= 2"
keep
finish

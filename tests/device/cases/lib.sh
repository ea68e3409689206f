# Sourced by the cases, which run as root inside the guest (tests/device/guest.sh) with the tree as their folder and
# /out to write to. HOVERMODAL_BIN: the programs. A case prints lines "ok|MISS<TAB>what<TAB>measured<TAB>bar".
set -uo pipefail
bin=${HOVERMODAL_BIN:-build/release/bin}
most_kib=${MOST_KIB:-128} # that a capture may grow by
misses=0

judge() { # WHAT MEASURED BAR CONDITION: an arithmetic condition of awk
  local verdict=MISS
  ! awk "BEGIN { exit !($4) }" </dev/null || verdict=ok
  [ $verdict = ok ] || misses=$((misses + 1))
  printf '%s\t%s\t%s\t%s\n' "$verdict" "$1" "$2" "$3"
}
# The kernel must have lived through it, too; and built with sanitizers, a program's every word of theirs is a miss.
finish() {
  local words
  words=$(dmesg | grep -m 1 -E 'BUG:|Oops|general protection fault|unable to handle')
  judge "faults of the kernel" "${words:-none}" "none" "\"${words//\"/}\" == \"\""
  if [ -n "${ASAN_OPTIONS:-}" ]; then
    words=$(grep -hE 'ERROR: [A-Za-z]*Sanitizer|runtime error:' /out/*.err /out/*.txt | head -n 3 | tr '\n' ';')
    judge "reports of AddressSanitizer, LeakSanitizer and UBSan" "${words:-none}" "none" "\"${words//\"/}\" == \"\""
  fi
  exit $((misses > 0))
}

wait_for() { # SECONDS COMMAND...: until it succeeds
  local end=$((SECONDS + $1)) && shift
  until "$@" >/dev/null 2>&1; do
    [ $SECONDS -lt $end ] || return 1
    sleep 0.1
  done
}

# capture NAME ARG...: through the driver, facts to /out/NAME.txt; fact NAME KEY
capture() {
  local name=$1 && shift
  "$bin/capture_check" "$@" >"/out/$name.txt" 2>"/out/$name.err"
}
fact() { awk -F'\t' -v key="$2" '$1 == key { print $2 }' "/out/$1.txt"; }
is_streaming() { wait_for 30 grep -q streaming "/out/$1.err"; } # NAME: its first frame has come

# vivid [PARAMETER=VALUE...]: a test camera of the kernel's, /dev/video0
vivid() {
  modprobe vivid n_devs=1 "$@" && wait_for 20 test -c /dev/video0
}
# What vivid offers at most on Linux 6.1, and what emulation keeps up with: on 6.12 it offers several times as much.
vivid_rate() { # SIZE
  case $1 in
    1920x1080) echo 5 ;;
    1280x720) echo 12.5 ;;
    *) echo 25 ;;
  esac
}
set_control() { v4l2-ctl -d /dev/video0 -c "$1" >/dev/null 2>&1; }

# vimc: a simulated pipeline for libcamera, which finds cameras through a running udev daemon; tests/device/vimc.sh builds it
vimc() {
  mkdir -p /run/udev
  /lib/systemd/systemd-udevd --daemon 2>/dev/null
  modprobe vimc || return 1
  udevadm trigger --subsystem-match=media --subsystem-match=video4linux
  udevadm settle -t 30
}

# plug_in FILE ARG...: the camera of usb_camera.cpp; its process in usb_pid, its node under /dev/video*
usb_pid=
usb_ready() {
  local entry
  for entry in /sys/class/video4linux/*; do
    [ -e "$entry/device/../idVendor" ] && v4l2-ctl -d "/dev/${entry##*/}" --get-fmt-video && return 0
  done
  return 1
}
plug_in() {
  modprobe -a vhci-hcd uvcvideo
  wait_for 20 test -w /sys/devices/platform/vhci_hcd.0/attach
  "$bin/usb_camera" "$@" &
  usb_pid=$!
  wait_for 90 usb_ready
}
usb_gone() { ! ls /sys/class/video4linux/*/device/../idVendor; }
pull_out() {
  kill "$usb_pid"
  wait "$usb_pid"
  wait_for 90 usb_gone
}
noise() { # FILE WIDTH HEIGHT N: gray frames none of which is like another
  head -c $(($2 * $3 * $4)) /dev/urandom >"$1"
}

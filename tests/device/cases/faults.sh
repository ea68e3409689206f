#!/usr/bin/env bash
# vivid misbehaves in each way it can; the driver must go on, and say what it lost.
. tests/device/cases/lib.sh
vivid
usual=(--source /dev/video0 --size 640x480 --format GREY --rate 25 --limit 60)
n=${FRAMES:-60}

# meanwhile NAME COMMAND...: COMMAND while the capture NAME runs
meanwhile() {
  local name=$1 && shift
  capture "$name" "${usual[@]}" --frames "$n" &
  local capture_pid=$!
  is_streaming "$name"
  sleep 0.5
  "$@"
  wait $capture_pid
}
outcome() { # NAME: what was delivered, in words
  echo "$(fact "$1" frames) frames, $(fact "$1" missing) missing in $(fact "$1" gaps) gaps, $(fact "$1" damaged) damaged, lost $(fact "$1" interruptions) times"
}
whole() { # NAME: a condition: all frames came in the end, and numbers add up
  echo "$(fact "$1" frames) == $n && $(fact "$1" frames) + $(fact "$1" missing) == $(fact "$1" span) && $(fact "$1" lost) == 0"
}

meanwhile error_flag set_control inject_v4l2_buf_flag_error=1
judge "a buffer flagged as damaged" "$(outcome error_flag)" "not used, counted" "$(whole error_flag) && $(fact error_flag damaged) >= 1 && $(fact error_flag missing) >= 1"

set_control percentage_of_dropped_buffers=30
capture dropped "${usual[@]}" --frames "$n"
set_control percentage_of_dropped_buffers=0
judge "30 % of buffers dropped" "$(outcome dropped)" "gaps counted" "$(whole dropped) && $(fact dropped missing) > 5"

meanwhile fatal set_control inject_fatal_streaming_error=1
judge "fatal streaming error" "$(outcome fatal)" "goes on by itself" "$(whole fatal) && $(fact fatal interruptions) == 1"

meanwhile disconnect set_control disconnect=1
judge "disconnected and back" "$(outcome disconnect)" "goes on by itself" "$(whole disconnect) && $(fact disconnect interruptions) >= 1"

rebind() {
  echo vivid.0 >/sys/bus/platform/drivers/vivid/unbind
  sleep 1
  echo vivid.0 >/sys/bus/platform/drivers/vivid/bind
}
meanwhile unbind rebind
judge "driver unbound and bound" "$(outcome unbind)" "goes on by itself" "$(whole unbind) && $(fact unbind interruptions) == 1"
modprobe -r vivid && vivid # its node has another number now

for step in reqbufs qbuf streamon; do
  broken() { # the error waits for the next such call, which the fatal error causes
    set_control "inject_vidioc_${step}_error=1"
    set_control inject_fatal_streaming_error=1
  }
  meanwhile "$step" broken
  judge "VIDIOC_${step^^} fails while it is set up again" "$(outcome "$step")" "tries again" "$(whole "$step") && $(fact "$step" interruptions) >= 1"
  set_control "inject_vidioc_${step}_error=1"
  capture "${step}_first" "${usual[@]}" --frames 5
  judge "VIDIOC_${step^^} fails at first" "$(fact "${step}_first" error)" "an error that names it" "\"$(fact "${step}_first" error)\" ~ /\\/dev\\/video0/"
done

set_control wrap_sequence_number=1
capture wrap "${usual[@]}" --frames 40
set_control wrap_sequence_number=0
judge "sequence number wraps at 2^32" "$(fact wrap frames) frames, $(fact wrap missing) missing" "no gap from it" "$(fact wrap frames) == 40 && $(fact wrap missing) == 0"

v4l2-ctl -d /dev/video0 --set-input=3 >/dev/null 2>&1
set_control dv_timings_signal_mode=1
capture silent --source /dev/video0 --frames 5 --limit 6
judge "no signal" "$(fact silent frames) frames, $(fact silent timeouts) timeouts of 0.2 s in 6 s; lost: $(fact silent lost)$(fact silent error)" "no hang, told" \
  "$(fact silent frames)+0 == 0 && ($(fact silent lost)+0 == 1 || \"$(fact silent error)\" != \"\")"
finish

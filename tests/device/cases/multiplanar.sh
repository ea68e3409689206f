#!/usr/bin/env bash
# vivid's multi-planar interface: formats whose planes lie in one buffer or in several, at three sizes: frames and gaps
# against the sequence numbers, these against the clock, and the luma of a still picture against what v4l2-ctl reads;
# then the contract and three faults.
. tests/device/cases/lib.sh
vivid multiplanar=2
set_control osd_text_mode=2 # none: the picture stands still
n=${FRAMES:-20}
formats=${FORMATS:-GREY NV12 NM12 NM21 YM12 YM21 NM16 NM61 YM16 YM61}
for size in ${SIZES:-640x480 1280x720 1920x1080}; do
  for format in $formats; do
    v4l2-ctl -d /dev/video0 --set-fmt-video="width=${size%x*},height=${size#*x},pixelformat=$format" --stream-mmap --stream-count=1 \
      --stream-to=/out/still.raw >/dev/null 2>&1
    head -c $((${size%x*} * ${size#*x})) /out/still.raw >/out/still.gray # luma comes first, whatever the planes
    capture "$format" --source /dev/video0 --size "$size" --format "$format" --rate "$(vivid_rate "$size")" --frames "$n" --limit 60 --sent /out/still.gray
    judge "vivid multi-planar $format $size" "$(fact "$format" frames) frames + $(fact "$format" missing) missing = $(fact "$format" span) numbers, $(fact "$format" span_by_time) by the clock; luma unchanged in $(fact "$format" unchanged)$(fact "$format" error)" \
      "exactly, $n frames" "$(fact "$format" frames)+0 == $n && $(fact "$format" frames) + $(fact "$format" missing) == $(fact "$format" span) && $(fact "$format" span_by_time) == $(fact "$format" span) && $(fact "$format" unchanged) == $n"
  done
done
rm -f /out/still.raw /out/still.gray

HOVERMODAL_CAMERA="v4l2 /dev/video0 640x480" "$bin/camera_contract_device" >/out/contract.txt 2>&1
passed=$(grep -c '^\[       OK' /out/contract.txt) failed=$(grep -c '^\[  FAILED  \] .*ms)' /out/contract.txt)
judge "contract of a driver: multi-planar vivid" "$passed passed, $failed failed" "7 of 7 (the end of a stream is not a live camera's)" "$passed == 7 && $failed == 0"

# fault NAME COMMAND...: COMMAND while frames are captured
fault() {
  local name=$1 && shift
  capture "$name" --source /dev/video0 --size 640x480 --format NM12 --rate 25 --frames 60 --limit 60 &
  local capture_pid=$!
  is_streaming "$name"
  sleep 0.5
  "$@"
  wait $capture_pid
}
for step in inject_v4l2_buf_flag_error inject_fatal_streaming_error disconnect; do
  fault "$step" set_control "$step=1"
  judge "multi-planar: $step" "$(fact "$step" frames) frames, $(fact "$step" missing) missing, $(fact "$step" damaged) damaged, lost $(fact "$step" interruptions) times" \
    "goes on by itself, counted" "$(fact "$step" frames)+0 == 60 && $(fact "$step" frames) + $(fact "$step" missing) == $(fact "$step" span) && $(fact "$step" damaged) + $(fact "$step" interruptions) >= 1"
done
finish

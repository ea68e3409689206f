#!/usr/bin/env bash
# vivid: every pixel format that it offers and we read, at three sizes: frames delivered and counted gaps against the
# sequence numbers, and these against the clock.
. tests/device/cases/lib.sh
vivid
formats=${FORMATS:-GREY Y10 Y12 Y16 YUYV UYVY NV12 YU12 RGB3 BGR3}
for size in ${SIZES:-640x480 1280x720 1920x1080}; do
  for format in $formats; do
    capture "$format" --source /dev/video0 --size "$size" --format "$format" --rate "$(vivid_rate "$size")" --frames "${FRAMES:-20}" --limit 60
    judge "vivid $format $size" "$(fact "$format" frames) frames + $(fact "$format" missing) missing in $(fact "$format" gaps) gaps = $(fact "$format" span) numbers, $(fact "$format" span_by_time) by the clock; $(fact "$format" rate_hz) Hz" \
      "exactly, ${FRAMES:-20} frames" "$(fact "$format" frames) + $(fact "$format" missing) == $(fact "$format" span) && $(fact "$format" frames) == ${FRAMES:-20} && $(fact "$format" span_by_time) == $(fact "$format" span)"
  done
done
finish

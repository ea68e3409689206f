#!/usr/bin/env bash
# A USB camera that plays known frames, through the kernel's uvcvideo driver: each must arrive as it was sent.
. tests/device/cases/lib.sh
noise /out/sent.gray 640 480 40
for format in GREY YUYV MJPG; do
  sent=/out/sent.gray more=()
  [ $format != MJPG ] || { sent=/out/luma.gray && more=(--luma $sent); } # not lossless: what the JPEG holds must come
  plug_in /out/sent.gray --format $format --rate "${RATE:-30}" "${more[@]}"
  capture "$format" --frames 60 --limit 60 --sent $sent
  judge "uvcvideo $format" "$(fact $format unchanged) of $(fact $format frames) frames unchanged, $(fact $format in_order) where their numbers say, $(fact $format missing) missing; $(fact $format rate_hz) Hz" \
    "60 of 60" "$(fact $format unchanged) == 60 && $(fact $format in_order) == 60"
  judge "uvcvideo $format exposure" "$(fact $format exposure_ms) ms, automatic exposure off: $(v4l2-ctl -C auto_exposure 2>/dev/null)" "locked" \
    "$(fact $format exposure_ms) > 0 && $(v4l2-ctl -C auto_exposure 2>/dev/null | grep -c ': 1') == 1"
  pull_out
done
rm -f /out/sent.gray /out/luma.gray
finish

#!/usr/bin/env bash
# The suite that all drivers pass (tests/support/camera_contract.h), on vivid, a USB camera, and vimc through libcamera.
. tests/device/cases/lib.sh
contract() { # NAME CAMERA
  HOVERMODAL_CAMERA=$2 "$bin/camera_contract_device" >"/out/$1.txt" 2>&1
  local passed failed
  passed=$(grep -c '^\[       OK' "/out/$1.txt") failed=$(grep -c '^\[  FAILED  \] .*ms)' "/out/$1.txt")
  judge "contract of a driver: $1" "$passed passed, $failed failed" "7 of 7 (the end of a stream is not a live camera's)" "$passed == 7 && $failed == 0"
}
vivid
contract vivid "v4l2 /dev/video0 640x480"
modprobe -r vivid
noise /out/sent.gray 640 480 10
plug_in /out/sent.gray
contract usb "v4l2 $(ls /dev/video* | head -n 1) 640x480"
pull_out
rm -f /out/sent.gray
vimc && contract vimc "libcamera B 318x240"
finish

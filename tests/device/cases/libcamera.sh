#!/usr/bin/env bash
# libcamera with vimc: listed, configured, streamed, stopped and started again; a camera that goes away and comes back.
. tests/device/cases/lib.sh
vimc
listed=$(LIBCAMERA_LOG_LEVELS='*:FATAL' cam -l 2>/dev/null | grep -c vimc)
sensor=(--driver libcamera --source "Sensor B")
capture odd "${sensor[@]}" --size 640x480 --frames 5 --limit 60
judge "vimc, 640 x 480 asked for" "$(fact odd error)$(fact odd camera), $(fact odd frames) frames" "told what becomes of it (a multiple of 3), or delivered (libcamera 0.4)" "\"$(fact odd error)\" ~ /636x480/ || (\"$(fact odd camera)\" ~ / 640 x 480$/ && $(fact odd frames)+0 == 5)"
capture vimc "${sensor[@]}" --size 636x480 --frames 30 --limit 60
judge "vimc, 636 x 480" "$listed cameras listed; $(fact vimc frames) frames, $(fact vimc missing) missing, $(fact vimc rate_hz) Hz; a step is off by at most $(fact vimc worst_step_frames) frames; no clock: $(fact vimc no_clock)" "30 frames, stamps on a known clock" \
  "$(fact vimc frames) == 30 && $(fact vimc no_clock) == 0 && $listed > 0"
capture again "${sensor[@]}" --size 318x240 --frames 5 --runs "${TIMES:-50}" --limit 60
judge "vimc started and stopped ${TIMES:-50} times" "$(fact again frames) frames; after the first 20 of them memory +$(fact again growth_kib) KiB, files +$(fact again growth_files)" "$((5 * ${TIMES:-50})) frames, at most +$most_kib KiB, no file" \
  "$(fact again frames) == 5 * ${TIMES:-50} && $(fact again growth_kib) <= $most_kib && $(fact again growth_files) <= 0"

capture back "${sensor[@]}" --size 318x240 --frames 1000000 --limit 60 &
capture_pid=$!
is_streaming back
sleep 2
echo vimc.0 >/sys/bus/platform/drivers/vimc/unbind
sleep 2
echo vimc.0 >/sys/bus/platform/drivers/vimc/bind
sleep 30
pkill -INT capture_check
wait $capture_pid
judge "vimc unbound and bound while it streams" "$(fact back frames) frames, lost $(fact back interruptions) times, lost now: $(fact back lost)" "goes on by itself" \
  "$(fact back interruptions) == 1 && $(fact back lost) == 0 && $(fact back frames) > 20"

# Out of the box libcamera refuses the USB camera: its virtual controller has no firmware path. A shim gives it one.
noise /out/sent.gray 640 480 40
plug_in /out/sent.gray
udevadm settle -t 30
capture bare --driver libcamera --source "Playback" --limit 5 --frames 1
LD_PRELOAD=$bin/libfirmware_node.so capture shimmed --driver libcamera --source VHCI-1:1.0-1d6b:0102 --size 640x480 --frames 30 --limit 60 --sent /out/sent.gray
judge "USB camera through libcamera, with a shim for its id (without: $(fact bare error | head -c 60))" "$(fact shimmed frames) frames, $(fact shimmed unchanged) unchanged, $(fact shimmed rate_hz) Hz$(fact shimmed error)" \
  "30 of 30" "$(fact shimmed unchanged)+0 == 30"
LD_PRELOAD=$bin/libfirmware_node.so capture usb_back --driver libcamera --source VHCI-1:1.0-1d6b:0102 --size 640x480 --frames 1000000 --limit 60 --sent /out/sent.gray &
capture_pid=$!
is_streaming usb_back
for _ in 1 2 3; do
  pull_out
  plug_in /out/sent.gray
  sleep 4
done
pkill -INT capture_check
wait $capture_pid
judge "USB camera through libcamera, unplugged and plugged in 3 times" "$(fact usb_back frames) frames, $(fact usb_back unchanged) unchanged, lost $(fact usb_back interruptions) times, lost now: $(fact usb_back lost)" \
  "goes on by itself, frames unchanged" "$(fact usb_back interruptions) == 3 && $(fact usb_back lost) == 0 && $(fact usb_back unchanged) == $(fact usb_back frames)"
pull_out
rm -f /out/sent.gray
finish

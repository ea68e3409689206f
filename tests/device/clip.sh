#!/usr/bin/env bash
# Draws the clip that the USB camera of cases/service.sh plays: clip.gray (raw frames), config.yaml and the modes of the
# true motion, in build/device/clip. Small and short: the guest that watches it is emulated.
set -euo pipefail
cd "$(dirname "$0")/../.."
bin=${HOVERMODAL_BIN:-build/release/bin}
clip=build/device/clip
[ "$(stat -c %s "$clip/clip.gray" 2>/dev/null)" != 345600000 ] || exit 0 # 1500 frames
"$bin/hovermodal" simulate --preset paper --duration 60 --size 640x360 --crf 4 --out "$clip" >"$clip.log" 2>&1
"$bin/hovermodal" identify --series "$clip/truth_displacements.csv" --base base --report "$clip/truth" >>"$clip.log" 2>&1
ffmpeg -nostdin -loglevel error -y -i "$clip/clip.mp4" -f rawvideo -pix_fmt gray "$clip/clip.gray"

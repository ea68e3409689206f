#!/usr/bin/env bash
# Draws the clip that the USB camera of cases/service.sh plays: clip.gray (raw frames), config.yaml and the modes of the
# true motion, in build/device/clip. Small and short: the guest that watches it is emulated. CLIP_SEED: of the scene.
set -euo pipefail
cd "$(dirname "$0")/../.."
bin=${HOVERMODAL_BIN:-build/release/bin}
clip=build/device/clip
seed=${CLIP_SEED:-1}
[ "$(stat -c %s "$clip/clip.gray" 2>/dev/null)" != 345600000 ] || [ "$(cat "$clip/seed" 2>/dev/null)" != "$seed" ] || exit 0 # 1500 frames
mkdir -p "$clip"
rm -f "$clip/seed"
"$bin/hovermodal" simulate --preset paper --seed "$seed" --duration 60 --size 640x360 --crf 4 --out "$clip" >"$clip.log" 2>&1
"$bin/hovermodal" identify --series "$clip/truth_displacements.csv" --base base --report "$clip/truth" >>"$clip.log" 2>&1
ffmpeg -nostdin -loglevel error -y -i "$clip/clip.mp4" -f rawvideo -pix_fmt gray "$clip/clip.gray"
echo "$seed" >"$clip/seed"

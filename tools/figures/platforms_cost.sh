# Figure "cost" of platforms.sh: what a board must do for each frame. Sourced by it.
# shellcheck shell=bash

# Instructions of the whole service (callgrind, AVX2, one thread at a time) on clips of two lengths: the difference is what a
# frame costs. Peak memory is that of the same run without callgrind, of a clip of 60 s.
figure_cost() {
  command -v valgrind >/dev/null || { line cost SKIP "no valgrind" - "instructions a frame (Debian: valgrind)"; return; }
  local size kind short long peak work=$out/cost keys=(--set tracking.points_per_region=30 --set tracking.min_distance_px=3 --set telemetry.lcm_url= --set closure.adopt=off)
  mkdir -p "$work"
  for size in 1280x720 1920x1080; do
    for seconds in 2 6 60; do
      quietly "$bin/hovermodal" simulate --preset paper --size "$size" --duration $seconds --seed "$first_seed" --out "$work/$size.$seconds" --threads "$(nproc)"
      [ $seconds = 60 ] || quietly ffmpeg -nostdin -y -i "$work/$size.$seconds/clip.mp4" -c:v rawvideo -pix_fmt gray "$work/$size.$seconds/clip.avi"
    done
    for kind in mp4 avi; do
      short=$(instructions "$size.2" $kind) long=$(instructions "$size.6" $kind)
      line "cost.$size.$kind" beside "$(awk "BEGIN { printf \"%.1f\", ($long - $short) / 100 / 1e6 }") million instructions a frame" - \
        "$([ $kind = mp4 ] && echo "H.264 as rendered, decoded on the processor" || echo "raw gray frames"), 7 regions of up to 30 points and the background, residual diagnosis off"
    done
    peak=$(python3 -c 'import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss // 1024)' "$bin/hovermodald" --config "$work/$size.60/config.yaml" "${keys[@]}")
    line "cost.$size.memory" beside "$peak MB" - "most memory of the service, 60 s of H.264 at 25 fps, spectra of 512, residual diagnosis off"
  done
  rm -rf "$work"
}
instructions() { # CLIP KIND
  valgrind --tool=callgrind --callgrind-out-file=/dev/null "$bin/hovermodald" --config "$work/$1/config.yaml" --set "camera.source=$work/$1/clip.$2" \
    "${keys[@]}" 2>&1 | awk '/Collected/ { print $NF }'
}

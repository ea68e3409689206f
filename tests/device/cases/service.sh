#!/usr/bin/env bash
# The whole service on a USB camera that plays a drawn clip (tests/device/clip.sh): the clip's modes must come out, and be
# heard over LCM by another process.
. tests/device/cases/lib.sh
clip=build/device/clip
url="udpm://239.255.76.67:7667?ttl=0"
# Played at 10 frames a second instead of 25, so that an emulated CPU can follow: frequencies and readout scale with it.
rate=${CLIP_RATE:-10}
slow=$(awk "BEGIN { print $rate / 25 }" </dev/null)
plug_in $clip/clip.gray --size 640x360 --rate "$rate"
"$bin/hovermodal" inspect cameras >/out/cameras.txt
judge "hovermodal inspect cameras" "$(grep -c 'driver: v4l2' /out/cameras.txt) camera, $(grep -o 'size: .*' /out/cameras.txt), $(grep -o 'stamps.*' /out/cameras.txt | tr -s ' ')" \
  "the camera and its YAML" "$(grep -c 'size: .640, 360' /out/cameras.txt) == 1"
"$bin/hovermodal" spy --url "$url" --plain --once --seconds 600 --count /out/spy.json >/out/spy.txt 2>&1 &
spy_pid=$!
wait_for 60 grep -q "listening on" /out/spy.txt
"$bin/hovermodald" --config $clip/config.yaml --set camera.driver=v4l2 --set camera.source=/dev/video0 --set "telemetry.lcm_url=$url" \
  --set camera.rate_hz="$rate" --set camera.readout_ms="$(awk '/readout_ms/ { print $2 / '$slow' }' $clip/config.yaml)" \
  --set tracking.points_per_region=8 --set spectrum.segment=256 --set closure.adopt=off --report /out/report >/out/service.txt 2>&1 &
service_pid=$!
# It must end before the clip starts again.
for ((i = 0; i < ${WATCH_S:-140}; i++)); do
  sleep 1
  kill -0 $service_pid 2>/dev/null || break
done
kill -TERM $service_pid 2>/dev/null
wait $service_pid
status=$?
[ $status -eq 0 ] || { tail -n 3 /out/service.txt && kill $spy_pid; }
wait $spy_pid
python3 - $slow $clip/truth/modal.json /out/report/modal.json /out/spy.txt >/out/modes.txt <<'PY'
import json, re, sys
truth, found = (json.load(open(p))["modes"] for p in sys.argv[2:4])
for t in truth:
    t["frequency_hz"] *= float(sys.argv[1])
heard = [float(x) for x in re.findall(r"(?m)^\s+(\d+\.\d{3,4})\s", open(sys.argv[4]).read())]
pairs = []
for t in truth:
    near = [m for m in found if abs(m["frequency_hz"] / t["frequency_hz"] - 1) < 0.03]
    if near:
        pairs.append((t, min(near, key=lambda m: abs(m["frequency_hz"] - t["frequency_hz"]))))
worst = max((abs(m["frequency_hz"] / t["frequency_hz"] - 1) for t, m in pairs), default=1)
told = sum(any(abs(h - m["frequency_hz"]) < 0.02 for h in heard) for t, m in pairs)
print(len(pairs), len(truth), f"{100 * worst:.2f}", told)
PY
read -r n_found n_true worst n_heard </out/modes.txt
losses=$(grep -o '[0-9]* frames in = .*' /out/service.txt | tail -n 1)
judge "modes of the clip out of the service, ended with $status" "$n_found of $n_true, at most $worst % off; $n_heard of them heard over LCM; $losses" "all modes of the clip (within 3 %), received by LCM in another process, exit 0" \
  "$n_true > 0 && $n_found == $n_true && $n_heard == $n_found && $status == 0"
pull_out
finish

# Figure 3 of real footage: telemetry beside or in a clip. Sourced by footage.sh.

# Every public sample: its description, or the text of its refusal; any other end (a crash, no text) is a MISS.
telemetry_samples() { # SET FILE...: from $data/SET
  local set=$1 file text code n=0 n_refused=0 bad=
  shift
  for file in "$@"; do
    code=0
    text=$("$bin/hovermodal" inspect telemetry "$file" 2>&1) || code=$?
    n=$((n + 1))
    [ $code -ne 1 ] || n_refused=$((n_refused + 1))
    { [ $code -le 1 ] && [ -n "$text" ]; } || bad="$bad ${file##*/}"
    echo "# ${file##*/}: $(tail -n +$((code == 0 ? 2 : 1)) <<<"$text" | tr -s ' \n' ' ' | sed "s|$data/||g" | cut -c1-240)"
  done
  judge 3 "$((n - n_refused)) parsed, $n_refused refused in words${bad:+, without a word:$bad}" "every one parsed or refused in words" \
    "$n samples of $set" "$n > 0 && \"$bad\" == \"\""
}

# All frames of a camera's own file, with its other streams, against ffprobe.
real_file() { # FILE
  local wanted counted words
  wanted=$(ffprobe -v error -select_streams v:0 -count_frames -show_entries stream=nb_read_frames -of csv=p=0 "$1" | tr -d ,)
  cat >"$out/real.yaml" <<Y
camera: {source: "$1"}
regions: [{name: middle, rect: [300, 160, 240, 160]}]
scale: {adaptive: false}
spectrum: {segment: 64}
telemetry: {lcm_url: ""}
Y
  words=$("$bin/hovermodald" --config "$out/real.yaml" --report "$out/real" 2>&1) || true
  counted=$(grep -o '[0-9]* frames in = [0-9]* processed' <<<"$words" | head -n 1)
  judge 3 "${counted:-none}" "all $wanted frames, as ffprobe decodes them" "${1##*/}, read with its other streams" \
    "\"${counted%% *}\" == \"$wanted\""
}

# A rendered clip whose frames are unevenly spaced in time, in a container that states even times; only the .SRT is right.
# Half-way it zooms in by 1.5 % (scaled and cropped by ffmpeg), and its stated exposure doubles.
srt_for() { # FOLDER: writes FOLDER/zoomed/clip.mp4 and its SRT, from the simulator's clip and time stamps
  local middle
  middle=$(($(wc -l <"$1/clip.timestamps.csv") / 2))
  mkdir -p "$1/zoomed"
  ffmpeg -nostdin -v error -y -i "$1/clip.mp4" -filter_complex "[0:v]trim=end_frame=$middle,setpts=N/25/TB[a];
    [0:v]trim=start_frame=$middle,setpts=N/25/TB,scale=iw*1.015:ih*1.015:flags=lanczos,crop=1920:1080[b];
    [a][b]concat=n=2:v=1,setpts=N/25/TB" -r 25 -c:v libx264 -preset veryfast -crf 12 "$1/zoomed/clip.mp4"
  python3 - "$1" "$middle" <<'P'
import csv, sys
folder, middle = sys.argv[1], int(sys.argv[2])
times = [float(row["t_s"]) for row in csv.DictReader(l for l in open(f"{folder}/clip.timestamps.csv") if not l.startswith("#"))]
with open(f"{folder}/zoomed/clip.SRT", "w") as out:
    for k, t in enumerate(times):
        us = round((t - times[0]) * 1e6) + 7_000_000
        exposure = 1000.0 if k < middle else 500.0
        focal = 2400 if k < middle else 2436
        out.write(f"{k + 1}\n00:00:00,000 --> 00:00:00,000\n<font size=\"36\">SrtCnt : {k + 1}, DiffTime : 40ms\n"
                  f"2022-08-07 10:{us // 60_000_000:02}:{us // 1_000_000 % 60:02},{us // 1000 % 1000:03},{us % 1000:03}\n"
                  f"[iso : 100] [shutter : 1/{exposure}] [focal_len : {focal}] </font>\n\n")
P
}

srt_clip() {
  local dir=$out/srt with without words
  rm -rf "$dir" "$dir.yaml"
  cat >"$dir.yaml" <<Y
preset: paper
duration_s: ${quick:+30}${quick:-60}
timing: {jitter_rms_ms: 1, drop_probability: 0.01}
Y
  sed -i 's/30yes/30/' "$dir.yaml"
  quietly "$bin/hovermodal" simulate --scene "$dir.yaml" --seed "$first_seed" --out "$dir" || { line 3 MISS "no clip" "-" "rendered clip"; return; }
  quietly "$bin/hovermodald" --config "$dir/config.yaml" --set telemetry.lcm_url= --report "$dir/stamps" || { line 3 MISS "the run failed" "-" "with stamps"; return; }
  srt_for "$dir"
  quietly "$bin/hovermodald" --config "$dir/config.yaml" --set telemetry.lcm_url= --set "camera.source=$dir/zoomed/clip.mp4" --report "$dir/srt" || { line 3 MISS "the run failed" "-" "with the SRT"; return; }
  words=$(python3 - "$dir/stamps/modal.json" "$dir/srt/modal.json" <<'P'
import json, sys
a, b = (json.load(open(path)) for path in sys.argv[1:])
pick = lambda run: [m for m in run["modes"] if m.get("verdict", "structural") == "structural"]
worst, found = 0.0, 0
for mode in pick(a):
    off = min((abs(m["frequency_hz"] / mode["frequency_hz"] - 1) for m in pick(b)), default=9.0)
    if off < 0.02:
        found, worst = found + 1, max(worst, 100 * off)
r = b["recording"]
said = "SRT" in r["times_from"] and "exposure changes" in (r["remark"] or "") and "focal length changes" in (r["remark"] or "")
print(found, len(pick(a)), len(pick(b)) - found, f"{worst:.3f}", int(said), r["frames_lost"])
P
  )
  # shellcheck disable=SC2086
  set -- $words
  judge 3 "$1 of $2 modes and $3 others, worst $4 %; $6 frames missing by the SRT; exposure and zoom said: $5" "modes as without, worst <= 0.3 %, changes said" \
    "rendered clip, 1 % of its frames lost, uneven, zooming by 1.5 %; times only in its SRT" "$1 == $2 && $3 == 0 && $4 <= 0.3 && $5 == 1"
}

figure_3() {
  local set file files
  for set in dji_srt gopro_gpmf gopro_telemetry; do
    [ -d "$data/$set" ] || { line 3 SKIP "no data at $data/$set" "every one parsed or refused in words" "samples of $set"; continue; }
    files=()
    for file in "$data/$set"/*; do files+=("$file"); done
    telemetry_samples "$set" "${files[@]}"
  done
  if [ -e "$data/dji_srt/MAVIC3.srt" ]; then
    local words
    words=$("$bin/hovermodal" inspect telemetry "$data/dji_srt/MAVIC3.srt" | grep -o "[0-9.]* frames/s, [0-9.]* ms rms")
    judge 3 "$words" "50.000 fps, 0.8 ms" "Mavic 3, by the camera's clock" "${words%% *} == 50.000 && $(cut -d' ' -f3 <<<"$words") >= 0.75 && $(cut -d' ' -f3 <<<"$words") < 0.85"
  fi
  for file in max-heromode.mp4 karma.mp4; do
    [ ! -e "$data/gopro_gpmf/$file" ] || real_file "$data/gopro_gpmf/$file"
  done
  srt_clip
}

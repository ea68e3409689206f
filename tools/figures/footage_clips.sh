# Figures 1 and 6 of real footage: damaged versions of a rendered clip, and reading speed. Sourced by footage.sh.
whole=$out/whole

# The demo's clip, its run, and its properties: made once.
whole_clip() {
  local seconds=60
  segment=512
  [ -z "$quick" ] || seconds=30 segment=256
  [ -e "$whole/clip_$seconds.$first_seed" ] && return
  rm -rf "$whole"
  quietly "$bin/hovermodal" simulate --preset paper --duration $seconds --seed "$first_seed" --out "$whole" &&
    quietly "$bin/hovermodald" --config "$whole/config.yaml" --set telemetry.lcm_url= --set spectrum.segment=$segment --report "$whole/report" &&
    touch "$whole/clip_$seconds.$first_seed"
}

encode() { # FFMPEG ARGUMENTS... OUT: rendering takes 10 s a minute; the second encoding stays close to the first
  ffmpeg -nostdin -v error -y "${@:1:$#-1}" -an -c:v libx264 -preset veryfast -crf 12 "${@: -1}"
}

# places CLIP: number of frames, and of empty cells of a grid of 25 Hz between the first and the last, by ffprobe alone.
places() {
  ffprobe -v error -select_streams v:0 -show_entries packet=pts_time -of csv=p=0 "$1" | tr -d , | sort -g |
    awk 'NR == 1 { first = $1 } { last = $1 } END { print NR, int((last - first) * 25 + 1.5) - NR }'
}

# damaged NAME LOST REPEATED: the run on NAME, evaluated; LOST and REPEATED are the true numbers of the damage.
damaged() {
  local dir=$out/$1 counts words
  quietly "$bin/hovermodald" --config "$whole/config.yaml" --set telemetry.lcm_url= --set spectrum.segment=$segment --set "camera.source=$out/$1.$4" --report "$dir" ||
    { line 1 MISS "the run failed" "all modes, <= 0.3 %" "$5"; return; }
  counts=$(python3 - "$dir/modal.json" <<'P'
import json, sys
r = json.load(open(sys.argv[1]))["recording"]
print(r["frames_lost"], r["frames_repeated"], r["frames_damaged"])
P
  )
  words=$(python3 - "$whole/report/modal.json" "$dir/modal.json" <<'P'
import json, sys
whole, run = (json.load(open(path))["modes"] for path in sys.argv[1:])
structural = [[m for m in modes if m.get("verdict", "structural") == "structural"] for modes in (whole, run)]
worst, found = 0.0, 0
for mode in structural[0]:
    off = min((abs(m["frequency_hz"] / mode["frequency_hz"] - 1) for m in structural[1]), default=9.0)
    if off < 0.02:
        found, worst = found + 1, max(worst, 100 * off)
print(found, len(structural[0]), len(structural[1]) - found, f"{worst:.3f}")
P
  )
  # shellcheck disable=SC2086
  set -- "$1" "$2" "$3" "$4" "$5" $words $counts
  judge 1 "$6 of $7 modes and $8 others, worst $9 %; ${10} lost, ${11} repeated, ${12} damaged" \
    "modes as in the whole clip, worst <= 0.3 %, $2 lost and $3 repeated" "$5" \
    "$6 == $7 && $8 == 0 && $9 <= 0.3 && ${10} == $2 && ${11} == $3 && ${12} == 0"
}

figure_1() {
  whole_clip || { line 1 MISS "the clip could not be made" "-" "the demo's clip"; return; }
  local clip=$whole/clip.mp4 n_frames
  n_frames=$(places "$clip" | cut -d' ' -f1)

  encode -i "$clip" -vf "select='gt(random(7)\,0.08)'" -vsync vfr "$out/random.mp4"
  damaged random "$(places "$out/random.mp4" | cut -d' ' -f2)" 0 mp4 "8 % of the frames left out, times kept"
  encode -i "$clip" -vf "select='not(between(n,300,389))'" -vsync vfr "$out/gap.mp4"
  damaged gap 90 0 mp4 "a gap of 3.6 s"
  encode -i "$clip" -vf "select='mod(n+1,7)'" -vsync vfr "$out/seventh.mp4"
  damaged seventh "$(places "$out/seventh.mp4" | cut -d' ' -f2)" 0 mp4 "every seventh frame gone"
  encode -i "$clip" -vf fps=30 "$out/thirty.mp4"
  damaged thirty 0 $(($(places "$out/thirty.mp4" | cut -d' ' -f1) - n_frames)) mp4 "every sixth frame repeated, 25 -> 30 fps"
  # Sound of two samples a packet: 900 packets between two frames.
  ffmpeg -nostdin -v error -y -i "$clip" -itsoffset 10 -f lavfi -i "sine=r=48000:d=0.0375,asetnsamples=n=2" \
    -map 0:v -map 1:a -c:v copy -c:a pcm_s16le "$out/packets.mkv"
  damaged packets 0 0 mkv "$(ffprobe -v error -select_streams a:0 -count_packets -show_entries stream=nb_read_packets -of csv=p=0 "$out/packets.mkv" | tr -d ,) packets of another stream in one place"
  encode -i "$clip" -vf "select='not(between(n,301,325))'" -vsync cfr -r 25 "$out/frozen.mp4"
  damaged frozen 0 25 mp4 "one frozen second"
  encode -i "$clip" -vf "select='not(between(n,301,325))'" -vsync vfr "$out/missing.mp4"
  damaged missing 25 0 mp4 "one missing second"
  joined_parts "$clip"
}

# The two halves of the clip at 25 and at 30 fps, joined: must be refused with both rates and the position in the message.
joined_parts() {
  local words code=0
  encode -i "$1" -vf "settb=1/15000,setpts='if(lt(N,400),N/25,16+(N-400)/30)/TB'" -vsync vfr -enc_time_base 1:15000 "$out/joined.mp4"
  words=$("$bin/hovermodald" --config "$whole/config.yaml" --set telemetry.lcm_url= --set "camera.source=$out/joined.mp4" --check 2>&1) || code=$?
  judge 1 "exit code $code; $(grep -o 'the frame rate changes.*' <<<"$words" | cut -c1-70)" \
    "refused in words: both rates, where, what to do" "concatenated parts of 25 and 30 fps" \
    "$code == 1 && \"$(grep -c 'changes from 25 to 30 Hz at about 1[4-7].*cut the clip there' <<<"$words")\" == \"1\""
}

figure_6() {
  quietly tools/build.sh decode_speed
  whole_clip || { line 6 MISS "the clip could not be made" "-" "the demo's clip"; return; }
  local clip ratio
  for clip in "$whole/clip.mp4" "$data/knex_frame_video/knex_1300x2046_gray.mp4"; do
    [ -e "$clip" ] || { line 6 SKIP "no data at $clip" ">= 1.0" "filmed clip"; continue; }
    "$bin/decode_speed" "$clip" 5 >"$out/speed.txt" || { line 6 MISS "the bench failed" ">= 1.0" "$clip"; continue; }
    ratio=$(awk "{ print \$3 }" "$out/speed.txt")
    judge 6 "$(awk "{ print \$1 \" frames/s, OpenCV \" \$2 \", ratio \" \$3 \"; largest difference of a pixel \" \$5 }" "$out/speed.txt")" ">= 1.0 of OpenCV's frames per second" "${clip##*/}, in turns" "$ratio >= 1.0"
  done
}

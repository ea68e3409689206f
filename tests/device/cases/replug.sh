#!/usr/bin/env bash
# A USB camera whose cable is pulled and put back while it streams, at another port each time; damaged and short frames.
. tests/device/cases/lib.sh
times=${TIMES:-50}
noise /out/sent.gray 320 240 40
frames() { plug_in /out/sent.gray --size 320x240 --rate 30 "$@"; }
frames --port 0
capture replug --frames 1000000 --limit $((times * 6 + 20)) --sent /out/sent.gray &
capture_pid=$!
is_streaming replug
n=0
for ((i = 1; i <= times; i++)); do
  pull_out
  frames --port $((i % 8)) && n=$((n + 1))
  sleep 1.2
done
pkill -INT capture_check
wait $capture_pid
judge "unplugged and plugged in $times times" "came back $n times; $(fact replug frames) frames, lost $(fact replug interruptions) times, $(fact replug unchanged) unchanged, lost now: $(fact replug lost); memory +$(fact replug growth_kib) KiB, files +$(fact replug growth_files)" \
  "each time, all frames unchanged, at most +$most_kib KiB, no file" "$(fact replug interruptions) == $times && $(fact replug unchanged) == $(fact replug frames) && $(fact replug lost) == 0 && $(fact replug growth_kib) <= $most_kib && $(fact replug growth_files) <= 0"
pull_out

modprobe -r uvcvideo
modprobe uvcvideo nodrop=1 # deliver damaged frames, flagged, instead of leaving them out
frames --error-every 5 --short-every 7
capture damaged --frames 60 --limit 40 --sent /out/sent.gray
judge "error bits and short frames, delivered" "$(fact damaged frames) frames, $(fact damaged damaged) damaged, $(fact damaged missing) missing" "none used, all counted" \
  "$(fact damaged unchanged) == 60 && $(fact damaged damaged) >= 15 && $(fact damaged missing) >= $(fact damaged damaged)"
pull_out
modprobe -r uvcvideo
modprobe uvcvideo
frames --error-every 5 --short-every 7
capture left_out --frames 60 --limit 40 --sent /out/sent.gray
judge "error bits and short frames, left out by the driver" "$(fact left_out frames) frames, $(fact left_out missing) missing" "none used, gaps counted" \
  "$(fact left_out unchanged) == 60 && $(fact left_out missing) >= 15"
pull_out
rm -f /out/sent.gray
finish

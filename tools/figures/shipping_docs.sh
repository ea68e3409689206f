#!/usr/bin/env bash
# Figure 5 of shipping: the documents on a clean Debian 12, followed to the letter. A root folder is made with mmdebstrap, the
# repository cloned into it, and README's commands run there as they stand, from the first apt-get to the modes of a clip of
# one's own. One line a command. As root; a gigabyte of packages, two hours on two processors. --quick: README's commands, the demo
# with 20 s, tools/test.sh only the unit tests.
#   tools/figures/shipping_docs.sh [--quick] [PART...]      PART: root demo test own readout spy (default: all, in this order);
#                                                           without root, the last commit in the root that is there
# HOVERMODAL_CCACHE=DIR is used as the compiler's cache in it (the lines say so); all else is as on a new machine.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/shipping_docs.sh [--quick] [PART...]" "$@"
all_or_named root demo test own readout spy
draws
parts=("${figures[@]}")
out=$PWD/build/figures/shipping
root=$out/clean
mkdir -p "$out"
. tools/figures/clean_root.sh

# follow NUMBER COMMAND [ARGUMENT-OF---quick]: a line for it, with its time.
follow() {
  local number=$1 command=$2 verdict=ok began=$SECONDS
  [ -z "$quick" ] || command+=${3:-}
  inside "$command" >"$out/docs_$number.log" 2>&1 </dev/null || verdict=MISS
  line "5.$number" $verdict "$((SECONDS - began)) s: $(grep -v '^$' "$out/docs_$number.log" | tail -n 1 | cut -c1-120)" "works as it stands$with" "$command"
}

# The commands of the section "Your own video", extracted by documents.py.
own_video() { awk '/^## Your own video/ { on = 1; next } /^## / { on = 0 } on && /^    (hovermodal|hovermodald|ffmpeg) / { sub(/^    /, ""); sub(/  +#.*/, ""); print }' README.md; }
flight_yaml() { awk '/<!-- file: flight.yaml -->/ { on = 1; next } on && !/^    / { exit } on { sub(/^    /, ""); print }' README.md; }

own() {
  # The reader's clip is replaced by the simulator's.
  follow clip "hovermodal simulate --preset paper --duration 30 --out fixture && cp fixture/clip.mp4 flight.mp4"
  flight_yaml >"$root/hovermodal/flight.yaml"
  local n=0 command
  while read -r command; do
    n=$((n + 1))
    follow "own$n" "$command"
  done < <(own_video)
  judge 5.own "$n commands" "6" "of \"Your own video\" in README.md" "$n == 6"
}
# A phone's record replaces a reader's. Its clip begins at the hundredth stamp.
readout() {
  local phone=$data/phone_rolling_shutter_gyro
  local command="hovermodal readout --clip frames --stamps framestamp.txt --gyro gyro.txt"
  [ -d "$phone/frames" ] || { line 5.readout SKIP "no data at $phone" "works as it stands" "$command; brought by: tools/data.sh"; return; }
  rm -rf "$root/hovermodal/frames"
  cp -r "$phone/frames" "$phone/gyro.txt" "$root/hovermodal/"
  sed 1,99d "$phone/framestamp.txt" >"$root/hovermodal/framestamp.txt"
  follow readout "$command"
  rm -rf "$root/hovermodal/frames" "$root/hovermodal/gyro.txt" "$root/hovermodal/framestamp.txt"
}

clean_up() { leave; }
figure_5() {
  if ! can_make_root; then
    line 5 SKIP "not root, or no mmdebstrap" "every command works" "the documents on a clean Debian 12; as root: apt-get install -y mmdebstrap"
    return
  fi
  if [ "${parts[0]}" = root ]; then
    make_root bookworm
    line 5.root ok "$(du -sm "$root" 2>/dev/null | cut -f1) MB, $(chroot "$root" dpkg-query -f '.' -W | wc -c) packages" "-" "a clean Debian 12 (minbase) with git and a clone"
  fi
  enter
  local part
  for part in "${parts[@]}"; do
    case $part in
      root) ;;
      demo) follow demo "tools/demo.sh" " --seconds 20" ;;
      test) follow test "tools/test.sh" " -L unit" ;;
      own) own ;;
      readout) readout ;;
      # lcm-spy does not end by itself; only without --quick, because it requires a JDK.
      spy) [ -n "$quick" ] && line 5.spy SKIP "not with --quick" "works as it stands" "lcm-spy; run: tools/figures/shipping_docs.sh spy" || follow spy "tools/setup.sh --lcm && tools/build.sh && { Xvfb :99 & DISPLAY=:99 timeout -s INT 10 tools/lcm_spy.sh 'udpm://239.255.76.67:7667?ttl=1'; code=\$?; kill %1; wait; [ \$code = 124 ]; }" ;;
    esac
  done
}

run_figures 5

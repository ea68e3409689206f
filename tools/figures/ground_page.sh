#!/usr/bin/env bash
# The pages of `hovermodal ground` and `hovermodal regions` in a browser without a screen, and their web server under attack.
# One line a figure; ten minutes, --quick: six. Pictures: build/figures/ground/desktop.png, phone.png, regions_page.png.
#   tools/figures/ground_page.sh [--quick] [--first-seed N] [FIGURE...]      FIGURE: some of 1, 2, 6h, 7p (default: all)
# SKIP where there is no multicast on this computer (ip route add 224.0.0.0/4 dev lo).
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/ground_page.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
all_or_named 1 2 6h 7p
draws 1 6h 7p
hours=24 fuzzed=3000 slow_s=60
[ -z "$quick" ] || hours=6 fuzzed=500 slow_s=15
out=$PWD/build/figures/ground
url="udpm://239.255.76.71:7671?ttl=0"
mkdir -p "$out"
set_up --ground
quietly tools/build.sh hovermodal hovermodald ground_day
export PYTHONDONTWRITEBYTECODE=1

value() { awk -F'\t' -v name="$2" '$1 == name { v = $2 } END { print v == "" ? "nan" : v }' "$out/$1.txt"; } # FILE NAME
# check FILE SCRIPT ARGUMENT...: its figures into FILE; prints its output if it fails.
check() {
  local name=$1 script=$2
  shift 2
  python3 "tests/ground/$script" "$@" >"$out/$name.txt" 2>"$out/$name.err" || { tail -n 3 "$out/$name.err" >&2; return 1; }
}
has_multicast() { ip route get 239.255.76.71 >/dev/null 2>&1; }
skip_multicast() { line "$1" SKIP "no multicast route" "$2" "$3; the route is made by: ip route add 224.0.0.0/4 dev lo, as root"; } # NUMBER BAR WHAT
clip() { # a simulated flight of three minutes
  printf 'preset: paper\nduration_s: 180\nseed: %s\n' "$first_seed" >"$out/scene.yaml"
  quietly "$bin/hovermodal" simulate --scene "$out/scene.yaml" --size 640x360 --out "$out/clip" --threads "$(nproc)"
}

# --- 1: the page beside a live service --------------------------------------------------------------------------------
figure_1() {
  local what="the page in chromium beside a live service on a simulated clip in real time"
  has_multicast || { skip_multicast 1 "modes appear, update, survive a service restart and a lost link" "$what"; return; }
  clip
  rm -f "$out/page.txt"
  check page page_run.py "$bin" "$out/clip" "$out" "$url" || { line 1 MISS "the check ended early: $(tail -n 1 "$out/page.err")" "modes appear, update, survive a service restart and a lost link" "$what"; return; }
  v() { value page "$1"; }
  s() { [[ $(v "$1") =~ ^[0-9.]+$ ]] && v "$1" || echo nan; } # seconds, if ever measured
  judge 1 "$(v modes) modes, first after $(v modes_after_s) s, again after $(v update_after_s) s" "modes appear and update" "$what" \
    "$(v modes) > 0 && $(s modes_after_s) >= 0 && $(s update_after_s) >= 0"
  judge 1r "shown after $(v restart_shown_s) s, modes again after $(v modes_after_restart_s) s" "survives a service restart" "the service stopped and started again: shown, and followed" \
    "$(s restart_shown_s) >= 0 && $(s modes_after_restart_s) >= 0"
  judge 1l "silence shown after $(v silence_shown_s) s, over $(v silence_over_s) s after it came back" "survives a lost link" "the link silent for some seconds: shown, and gone on with" \
    "$(s silence_shown_s) >= 0 && $(s silence_over_s) >= 0"
  judge 1g "shown after $(v lost_station_shown_s) s, over $(v lost_station_over_s) s after it was started again" "survives it" \
    "the ground station killed and started again: shown, and gone on with" \
    "$(s lost_station_shown_s) >= 0 && $(s lost_station_over_s) >= 0"
  judge 1c "$(v console_lines) errors or warnings of the page, $(v network_lines) of the network while the station lived; $(v refused_connections) refused connections told by the browser in all" \
    "0 console errors" "the browser's console; what the browser itself says while there is no station to connect to is printed, not judged" "$(v console_lines) == 0 && $(v network_lines) == 0"
  judge 1p "$(v first_paint_ms) ms" "under 1 s" "first paint on loopback" "$(v first_paint_ms) < 1000"
  judge 1w "$(v page_bytes) bytes" "under 300 kB" "weight of the page" "$(v page_bytes) < 300000 && $(v page_bytes) > 10000"
  judge 1k "space pauses: $(v space_pauses); $(v tabbable) parts to tab to; $(v desktop_overflow_px) and $(v phone_overflow_px) px beyond the right edge" \
    "true, some, 0 and 0" "keyboard, and 1320 and 390 px wide" "\"$(v space_pauses)\" == \"true\" && $(v tabbable) > 3 && $(v desktop_overflow_px) == 0 && $(v phone_overflow_px) == 0"
}

# --- 2: a day ---------------------------------------------------------------------------------------------------------
figure_2() {
  local what="JavaScript heap over $hours h of messages at 30 frames a second fed to the page"
  rm -f "$out/day.txt"
  # A log as the source needs no network.
  "$bin/ground_day" log "$out/day.lcm"
  check day page_day.py "$bin" "$out" "file://$out/day.lcm?speed=0" "$hours" || { line 2 MISS "the check ended early: $(tail -n 1 "$out/day.err")" "page memory bounded" "$what"; return; }
  v() { value day "$1"; }
  judge 2 "$(awk -F'\t' '/^heap/ { printf "%s%s %.2f MB", sep, substr($1, 6), $2 / 1e6; sep = ", " }' "$out/day.txt"); $(v estimates_kept) estimates and $(v samples_kept) samples a channel kept, $(v nodes) elements" \
    "page memory bounded" "$what; bounded: at most 1 MB more than after the first hour" "$(v "heap_${hours}_h") - $(v heap_1_h) < 1e6 && $(v console_lines) == 0"
  local first last rate
  read -r first last rate < <("$bin/ground_day" feed "$hours" || echo "nan nan nan")
  judge 2s "$(awk "BEGIN { printf \"%.1f MB after 1 h, %.1f MB after %s h, %.0f times real time\", $first / 1e6, $last / 1e6, \"$hours\", $rate }")" \
    "bounded" "memory of the ground station over the same messages; bounded: at most 2 MB more than after the first hour" "$last - $first < 2e6"
}

# --- 6h: HTTP ---------------------------------------------------------------------------------------------------------
figure_6h() {
  local what="$fuzzed fuzzed requests (seeds $first_seed to $((first_seed + fuzzed - 1)))"
  has_multicast || { skip_multicast 6h "refused, service unharmed" "$what"; return; }
  clip
  rm -f "$out/http.txt"
  check http http_attack.py "$bin" "$out/clip" "$out" "$url" "$fuzzed" 1000 "$slow_s" "$first_seed" || { line 6h MISS "the check ended early: $(tail -n 1 "$out/http.err")" "refused, service unharmed" "$what"; return; }
  v() { value http "$1"; }
  judge 6h.fuzz "$(v fuzzed_unanswered) left waiting, $(v fuzzed_faults) faults of the server" "0, 0" "$what" "$(v fuzzed_unanswered) == 0 && $(v fuzzed_faults) == 0"
  judge 6h.paths "$(v paths_not_refused) of $(v paths) not refused" "0" "paths to files" "$(v paths_not_refused) == 0"
  judge 6h.origins "$(v origins_not_refused) other origins and rebound names, $(v tokens_not_refused) wrong tokens not refused" "0, 0" "cross-origin requests, wrong tokens" \
    "$(v origins_not_refused) == 0 && $(v tokens_not_refused) == 0"
  judge 6h.slow "$(v normal_failed) of $(v normal_asked) requests failed, median $(v normal_median_ms) ms, worst $(v normal_worst_ms) ms; $(v slow_connections) slow connections in $slow_s s" \
    "0 failed" "a normal client beside 1000 slow ones that come back when closed" "$(v normal_failed) == 0 && $(v normal_asked) > 50"
  judge 6h.readers "$(v streams_open) of 50 event streams open, the page answered with $(v page_beside_slow_readers)" "16 at most, 200" "200 clients that read nothing" \
    "$(v streams_open) <= 16 && $(v page_beside_slow_readers) == 200"
  judge 6h.memory "grew by $(awk "BEGIN { printf \"%.1f\", $(v grown_bytes) / 1e6 }") MB to $(awk "BEGIN { printf \"%.1f\", $(v resident_bytes) / 1e6 }") MB" "32 MB" "memory of the ground station under attack" \
    "$(v grown_bytes) < 32e6"
  judge 6h.service "alive: $(v alive); $(v service_frames) frames processed on board, $(v service_frames_dropped) dropped, $(v messages_lost) messages lost on the link" \
    "alive, 0 dropped, 0 lost" "service and ground station on the same computer meanwhile" "\"$(v alive)\" == \"True\" && $(v service_frames_dropped) == 0 && $(v messages_lost) == 0"
}

# --- 7p: the page of regions ------------------------------------------------------------------------------------------
figure_7p() {
  local what="the page of hovermodal regions in chromium: drag, keys, a corner, a name, remove, add, save"
  clip
  rm -f "$out/picker.txt"
  check picker regions_run.py "$bin" "$out/clip" "$out" || { line 7p MISS "the check ended early: $(tail -n 1 "$out/picker.err")" "works" "$what"; return; }
  v() { value picker "$1"; }
  judge 7p "$(v proposed) proposed; dragged by $(v dragged_px), by keys $(v by_keys_px), by its corner $(v by_corner_px) px of the image; wrong name: $(v wrong_name); then $(v in_file) of $(v on_page) as on the page in the file" \
    "each moves as told, a wrong name is refused, the file is what the page shows" "$what" \
    "\"$(v by_keys_px)\" == \"[1, 10, 1, 0]\" && \"$(v dragged_px)\" ~ /^\\[[1-9][0-9]*, [1-9][0-9]*, 0, 0\\]$/ && \"$(v by_corner_px)\" ~ /^\\[0, 0, [1-9][0-9]*, [1-9][0-9]*\\]$/ && \"$(v wrong_refused)\" == \"True\" && \"$(v renamed)\" == \"True\" && $(v in_file) == $(v on_page) && $(v on_page) >= 5"
  judge 7p.layout "1320 x 900: $(v seen_together), 1280 x 600: $(v seen_together_low), phone 390 x 844: $(v seen_together_phone)" "all True" \
    "the whole picture, its boxes and Save within one window of the page of regions" \
    "\"$(v seen_together)$(v seen_together_low)$(v seen_together_phone)\" == \"TrueTrueTrue\""
  judge 7p.page "$(v console_lines) errors or warnings of the page, $(v phone_overflow_px) px beyond the right edge at 390 px" "0, 0" "console and phone" \
    "$(v console_lines) == 0 && $(v phone_overflow_px) == 0"
}

run_figures "${figures[@]}"

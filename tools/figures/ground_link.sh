#!/usr/bin/env bash
# The way from the service to the ground over LCM. One line a figure.
#   tools/figures/ground_link.sh [--quick] [--first-seed N] [FIGURE...]
#     FIGURE: some of 4 5 6 7 (default: all); --quick: a tenth of figure 6, the clip of figures 4, 5 and 7 at 30 s
# 4 lcm-spy with our types, 5 a bad radio link (as root), 6 malformed packets, 7 proposed regions.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/ground_link.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
all_or_named 4 5 6 7
seconds=60 hostile=1000000
[ -z "$quick" ] || seconds=30 hostile=100000
out=$PWD/build/figures/ground
types=build/release/python
mkdir -p "$out"
set_up --lcm
quietly tools/build.sh hovermodal hovermodald subscribe lcm_hostile hovermodal_python_messages
clip=$out/clip_${seconds}_$first_seed

own_network() { unshare -rn "$@"; }
# field FILE EXPRESSION: evaluated on a JSON file, which is j
field() { python3 -c 'import json, sys; j = json.load(open(sys.argv[1])); print(eval(sys.argv[2]))' "$1" "$2" 2>/dev/null || echo nan; }
need_clip() {
  [ -f "$clip/truth.json" ] || quietly "$bin/hovermodal" simulate --preset paper --seed "$first_seed" --duration $seconds --size 720p --out "$clip"
}
# A log and a record of one run: every kind of message. The record contains the attitude, a file that the configuration names.
need_log() {
  need_clip
  [ "$(cat "$out/run.of" 2>/dev/null)" != "$clip" ] || return 0
  rm -rf "$out/run.of" "$out/run.lcm" "$out/run_record"
  { echo t_s,roll_deg,pitch_deg,yaw_deg && seq -f '%g,0,0,0' 0 0.1 90; } >"$out/attitude.csv"
  quietly "$bin/hovermodald" --config "$clip/config.yaml" --set telemetry.lcm_url= --set "telemetry.log_file=$out/run.lcm" \
    --set closure.period_s=20 --set "record.directory=$out/run_record" --set "camera.attitude_file=$out/attitude.csv" --set scale.only=false
  echo "$clip" >"$out/run.of"
}

# --- 4: lcm-spy --------------------------------------------------------------------------------------------------------
figure_4() {
  local n_types=11  # types that a service sends and records, and attitude_t, which it receives
  local what="lcm-spy of Debian with hovermodal_lcm.jar, a log of one run" bar="every type decoded"
  if ! cmake -B build/release -S . >/dev/null 2>&1 || ! quietly tools/build.sh hovermodal_lcm_jar || ! command -v Xvfb >/dev/null; then
    line 4 SKIP "no JDK, no LCM for Java or no Xvfb" "$bar" "$what; installed by: tools/setup.sh --lcm"
    return
  fi
  need_log
  mkdir -p "$out/classes"
  local path=build/release/hovermodal_lcm.jar:/usr/share/java/lcm.jar
  quietly javac -nowarn -cp "$path" -d "$out/classes" tools/figures/LcmSpyCheck.java
  python3 tools/figures/lcm_log.py all-types "$out/run.lcm" "$out"/run_record/*_000.lcm "$out/all_types.lcm" $types >/dev/null
  java -cp "$path:$out/classes" LcmSpyCheck log "$out/all_types.lcm" >"$out/decoded.txt"
  local types_decoded errors messages
  read -r types_decoded errors messages < <(awk '$1 == "channel" { if ($4 != "unknown" && $8 == 0 && $6 > 0) n++; e += $8; m += $6 } END { print n + 0, e + 0, m + 0 }' "$out/decoded.txt")
  judge 4.types "$types_decoded of $n_types types, $messages messages, $errors not decoded ($(awk '$1 == "channel" { printf "%s%s", sep, $4; sep = " " }' "$out/decoded.txt"))" \
    "every type decoded" "$what, decoded through lcm-spy's own type search" "$types_decoded == $n_types && $errors == 0"
  own_network tools/figures/lcm_spy_run.sh "$out/all_types.lcm" "$out" || true
  local listed windows
  listed=$(awk '$1 == "channel" && $4 != "unknown" && $6 > 0 && $8 == 0 { n++ } END { print n + 0 }' "$out/lcm_spy.txt")
  windows=$(awk '$1 == "windows" { print $2 }' "$out/lcm_spy.txt")
  judge 4 "$listed of $n_types channels in the list with their type and nothing undecodable, ${windows:-0} windows show fields, $(awk '$1 == "channel" { n += $6; e += $8 } END { printf "%d messages, %d that lcm-spy calls undecodable", n, e }' "$out/lcm_spy.txt"); picture lcm_spy.png" "$bar" \
    "the program itself under Xvfb, the log played by lcm-logplayer" "$listed == $n_types && ${windows:-0} == $n_types"
}

# --- 5: a bad radio link -----------------------------------------------------------------------------------------------
figure_5() {
  local what="20 % loss, 100 ms, 256 kbit/s; clip paced in real time, every frame's tracks asked for, telemetry.max_kbit_s: 200" cap=200
  if [ "$(id -u)" -ne 0 ] || ! ip netns add hm_try_$$ 2>/dev/null; then
    line 5 SKIP "not root, or no network namespaces" "modes arrive, losses counted by sequence number, service unharmed" "$what; run it as root: sudo tools/figures/ground_link.sh 5"
    return
  fi
  ip netns del hm_try_$$
  need_clip
  local link=$out/link
  tools/figures/lcm_link_run.sh "$clip" "$link" $cap "$first_seed"
  what="$what; link: $(cat "$link/how.txt")"
  python3 tools/figures/lcm_log.py count "$link/ground.lcm" >"$link/ground.json"
  python3 tools/figures/lcm_log.py final "$link/run.lcm" $types >"$link/sky.json"
  python3 tools/figures/link_account.py "$link" >"$link/account.json"
  judge 5.modes "$(field "$link/account.json" 'j["modes"]') modes on the ground, $(field "$link/account.json" 'j["modes_sent"]') in the service's report; $(field "$link/account.json" 'j["estimates"]') estimates heard whole of $(field "$link/account.json" 'j["estimates_sent"]')" \
    "modes arrive" "$what" "$(field "$link/account.json" 'j["modes"]') >= 3"
  judge 5.losses "$(field "$link/account.json" 'j["words"]')" "losses counted by sequence number" "lost + heard = sent on each channel: messages counted by sequence (spy) against the service's counts and lcm-logger's log" \
    "$(field "$link/account.json" 'int(j["adds_up"])') == 1 && $(field "$link/account.json" 'j["lost"]') > 0"
  judge 5.service "exit $(cat "$link/exit.txt"), $(field "$link/sky.json" 'j["frames_in"]') frames in, $(field "$link/sky.json" 'j["frames_dropped"]') dropped, $(field "$link/sky.json" 'j["messages_failed"]') messages failed" \
    "service unharmed" "the service meanwhile: exit 0, no frame dropped" "$(cat "$link/exit.txt") == 0 && $(field "$link/sky.json" 'j["frames_dropped"]') == 0 && $(field "$link/sky.json" 'j["frames_in"]') > 0"
  judge 5.rate "$(field "$link/account.json" 'j["rate_words"]')" "telemetry bytes per second printed and capped" "what left the service's interface, in the mean at most $cap kbit/s; $(field "$link/account.json" 'j["held_words"]')" \
    "$(field "$link/account.json" 'j["mean_kbit_s"]') <= $cap && $(field "$link/account.json" 'j["mean_kbit_s"]') > 0"
}

# --- 6: malformed packets ----------------------------------------------------------------------------------------------
figure_6() {
  local seeds=10 counted
  counted=$("$bin/lcm_hostile" decode "$first_seed" $seeds $((hostile / seeds)) || echo "crashed")
  judge 6.decoders "${counted#fed }" "no crash, counted" "$hostile malformed messages of every type, each counted once, seeds $first_seed-$((first_seed + seeds - 1)), into StreamMonitor and AttitudeInbox" \
    "$(echo "$counted" | awk '{ print ($2 == '"$hostile"' && $2 == $4 + $6) ? 1 : 0 }') == 1"
  need_clip
  own_network tools/figures/lcm_hostile_run.sh "$clip" "$out/hostile" $hostile "$first_seed" >"$out/hostile.log" 2>&1 || true
  judge 6.sockets "$(cat "$out/hostile/result.txt" 2>/dev/null || echo "it did not end: $(tail -n 1 "$out/hostile.log")")" "10^6 at every subscriber: no crash, counted" \
    "$hostile datagrams at spy, inspect, both examples and the attitude listener, the last fifth with damaged heads and fragments (not at the C++ example: liblcm 1.3.1 itself ends on those)" \
    "$(grep -c '^ok' "$out/hostile/result.txt" 2>/dev/null || true) == 1"
}

# --- 7: proposed regions -----------------------------------------------------------------------------------------------
figure_7() {
  need_clip
  local folder=$out/regions base
  rm -rf "$folder"
  mkdir -p "$folder"
  quietly "$bin/hovermodal" regions "$clip/clip.mp4" --lowest-is-base --out "$folder/regions.yaml" --picture "$folder/regions.png"
  # The declared configuration with the proposed regions instead of its own, and no known length.
  awk '/^regions:/ { skip = 1; next } /^[a-z]/ { skip = /^scale:/ } !skip' "$clip/config.yaml" >"$folder/config.yaml"
  cat "$folder/regions.yaml" >>"$folder/config.yaml"
  local segment=512
  [ $seconds -ge 45 ] || segment=256
  local which
  quietly "$bin/hovermodald" --config "$folder/config.yaml" --set telemetry.lcm_url= --set spectrum.segment=$segment --report "$folder/proposed"
  quietly "$bin/hovermodald" --config "$clip/config.yaml" --set telemetry.lcm_url= --set spectrum.segment=$segment --report "$folder/declared"
  for which in proposed declared; do
    quietly "$bin/hovermodal" identify --series "$clip/truth_displacements.csv" --base base --report "$folder/truth"
    "$bin/hovermodal" compare --result "$folder/$which/modal.json" --reference "$folder/truth/modal.json" >"$folder/$which.txt" || true
  done
  local found proposed worst_proposed declared worst_declared
  found=$(grep -c 'name:' "$folder/regions.yaml")
  read -r proposed worst_proposed < <(awk '$1 ~ /^[0-9]+$/ && NF >= 4 { n++; e = $4 < 0 ? -$4 : $4; if (e > w) w = e } END { print n + 0, w + 0 }' "$folder/proposed.txt")
  read -r declared worst_declared < <(awk '$1 ~ /^[0-9]+$/ && NF >= 4 { n++; e = $4 < 0 ? -$4 : $4; if (e > w) w = e } END { print n + 0, w + 0 }' "$folder/declared.txt")
  judge 7 "$found regions proposed; modes found $proposed (worst error $worst_proposed %), with the declared regions $declared (worst $worst_declared %)" \
    "as many modes as declared, each of modes 1-3 within 1.04 %" "simulated clip of $seconds s, against the identification of the true motion" \
    "$proposed >= $declared && $(awk '$1 ~ /^[123]$/ && NF >= 4 { e = $4 < 0 ? -$4 : $4; if (e > 1.04) bad = 1; n++ } END { print (bad || n < 3) ? 0 : 1 }' "$folder/proposed.txt") == 1"
}

run_figures "${figures[@]}"

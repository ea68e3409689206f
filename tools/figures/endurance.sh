#!/usr/bin/env bash
# Nothing lost, whatever happens: reports, folders, hostile files and names, signals.
#   tools/figures/endurance.sh [--quick] [--first-seed N] [FIGURE...]     FIGURE: 1 2 3 4 5 6
# 7_readers 7_programs (default: all)
# 1 takes two minutes. Each of its lines is ok only where the behaviour is seen with the programs as delivered.
# 2 (a failing call in each of some thousand runs) takes an hour, 3 (200 kills) a quarter; --quick: every 25th call, 20 kills.
# 4 (100 power cuts in a virtual machine) takes six minutes; --quick: 10 cuts.
# 5 (peak memory of the readers) takes four minutes. 6 (ten hours of stream, twice) takes two hours; --quick: 42 minutes of stream.
# 7_readers and 7_programs (eight fuzz targets each, ten minutes a target) take an hour each on two processors; --quick: 20 s a target.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
. tools/figures/endurance_day.sh
. tools/figures/endurance_faults.sh
. tools/figures/endurance_fuzz.sh
. tools/figures/endurance_memory.sh
. tools/figures/endurance_power.sh
. tools/figures/endurance_running.sh
take_arguments "tools/figures/endurance.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
all_or_named 1 2 3 4 5 6 7_readers 7_programs
draws 2 3 4 6 7_readers 7_programs
bin=$PWD/$bin
work=$PWD/build/figures/endurance
mkdir -p "${work%/*}"
exec 9>"$work.lock"
flock -n 9 || refuse "another run of endurance.sh uses $work: wait for its end"
rm -rf "$work" && mkdir -p "$work"
set_up # shellcheck disable=SC2119

inputs() {
  quietly tools/build.sh hovermodal hovermodald
  printf 'preset: paper\nduration_s: 30\nseed: 3\n' >"$work/scene.yaml"
  quietly "$bin/hovermodal" simulate --scene "$work/scene.yaml" --size 480x270 --out "$work/clip" --threads "$(nproc)"
}
brief=(--set telemetry.lcm_url= --set closure.adopt=off --set spectrum.segment=256)
slow=(--set camera.pace=realtime) # thirty seconds, in which a run can be stopped
# service NAME OPTION...: its log in NAME.log, its exit code in $code, its seconds in $took.
code=0 took=0
service() {
  local log=$work/$1.log began
  shift
  began=$(date +%s%N)
  code=0
  timeout 60 "$bin/hovermodald" --config "$work/clip/config.yaml" "${brief[@]}" "$@" >"$log" 2>&1 || code=$?
  took=$(awk "BEGIN { printf \"%.1f\", ($(date +%s%N) - $began) / 1e9 }")
}
# in_background NAME OPTION...: its process in $pid, once it runs.
in_background() {
  local log=$work/$1.log
  shift
  "$bin/hovermodald" --config "$work/clip/config.yaml" "${brief[@]}" "${slow[@]}" "$@" >"$log" 2>&1 &
  pid=$!
  for _ in {1..100}; do
    ! grep -q 'channel ' "$log" || break
    sleep 0.1
  done
}
ended() { # FOR SECONDS: waits for $pid; its exit code in $code
  code=0
  timeout "$1" tail --pid="$pid" -f /dev/null || kill -KILL "$pid"
  wait "$pid" 2>/dev/null || code=$?
}
# state_of FOLDER: one digest of everything in it, names and contents.
state_of() { (cd "$1" && find . -type f -print0 | LC_ALL=C sort -z | xargs -0 sha256sum | sha256sum | cut -c1-16); }
# skipped_hup NUMBER SIGNAL: true, with a SKIP line, for SIGHUP where it is ignored from the start (nohup): the service leaves it so.
skipped_hup() {
  [ "$2" = HUP ] && ((0x$(awk '/^SigIgn/ { print $2 }' /proc/self/status) & 1)) || return 1
  line "1.$1.HUP" SKIP "SIGHUP is ignored here" "exit code 0 within 5 s, a complete report" "start it with setsid instead of nohup"
}
number_of_modes() { python3 -c 'import json, sys; print(len(json.load(open(sys.argv[1]))["modes"]))' "$1" 2>/dev/null || echo 0; }
said() { grep -c -- "$2" "$work/$1.log" || true; } # NAME TEXT: lines of a log with it
# check LETTER "measured" "bar" "what" CONDITION: as judge, in figure 1.
check() { judge "1.$1" "${@:2}"; }

reports() {
  local good=$work/good before
  service good --report "$good"
  before=$(state_of "$good")
  service refused --report "$good" --set rt.capture_cpu=1023 --set rt.required=true
  check a "exit code $code, report $([ "$(state_of "$good")" = "$before" ] && echo the same || echo changed), $(number_of_modes "$good/modal.json") modes" \
    "exit code 4, every byte the same" "a run that is refused before its first frame" \
    "$code == 4 && \"$(state_of "$good")\" == \"$before\" && $(number_of_modes "$good/modal.json") > 0"
  in_background killed --report "$good"
  sleep 3
  kill -KILL "$pid"
  ended 10
  local modes kept
  modes=$(number_of_modes "$good/modal.json") kept=$(find "$good/report.partial" -type f -size +0 2>/dev/null | wc -l)
  rm -rf "$work/partial" && cp -r "$good" "$work/partial" && rm -rf "$work/partial/report.partial"
  check b "$modes modes, $kept files of its own beside; the old report $([ "$(state_of "$work/partial")" = "$before" ] && echo the same || echo changed)" \
    "the old report as it was" "kill -9 three seconds into a run" \
    "$modes > 0 && $kept > 0 && \"$(state_of "$work/partial")\" == \"$before\""
  service again --report "$good"
  check c "exit code $code; $(number_of_modes "$good/modal.json") modes, $(number_of_modes "$good/report.1/modal.json") in report.1, $(said again report.unfinished) words about report.unfinished" \
    "a new report, the old one and the killed one beside it" "the restart after it" \
    "$code == 0 && $(number_of_modes "$good/modal.json") > 0 && $(number_of_modes "$good/report.1/modal.json") > 0 && $(said again report.unfinished) > 0 && $(find "$good/report.unfinished" -type f | wc -l) > 0"
}

folders() {
  local kind folder
  for kind in report record state; do
    folder=$work/one_$kind
    in_background "first_$kind" --set "$kind.directory=$folder"
    service "second_$kind" --set "$kind.directory=$folder"
    check "d.$kind" "exit code $code, first one named $(said "second_$kind" "process $pid") times" "exit code 2, the other process named" \
      "two services on one $kind.directory" "$code == 2 && $(said "second_$kind" "process $pid") > 0 && $(said "second_$kind" "$kind.directory") > 0"
    kill -TERM "$pid"
    ended 20
  done
  touch "$work/file"
  in_background no_state --set "state.directory=$work/file"
  sleep 2
  local early
  early=$(said no_state 'state.directory: .*without state')
  kill -TERM "$pid"
  ended 20
  check e "told $early times two seconds into the run, exit code $code" "told at the start, and the run goes on" "a state.directory that cannot be written" \
    "$code == 0 && $early > 0"
}

# peak NAME COMMAND...: largest resident memory in MB in $peak, exit code in $code; at most 20 s.
peak=0
peak() {
  local log=$work/$1.log
  shift
  code=0
  python3 - "$log" "$@" <<'P' >"$work/peak" || code=$?
import resource, subprocess, sys
with open(sys.argv[1], "w") as log:
    try:
        code = subprocess.run(sys.argv[2:], stdout=log, stderr=log, timeout=20).returncode
    except subprocess.TimeoutExpired:
        code = 124
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss // 1024)
sys.exit(code if code >= 0 else 128 - code)
P
  peak=$(cat "$work/peak")
}
# refused LETTER NAME TEXT BAR WHAT: the last peak ended with a refusal that says TEXT, below BAR megabytes.
refused() {
  check "$1" "exit code $code, $peak MB, \"$3\" said $(said "$2" "$3") times" "refused in words, below $4 MB" "$5" \
    "($code == 1 || $code == 2) && $peak < $4 && $(said "$2" "$3") > 0"
}
readers() {
  local clip=$work/hostile/clip.mp4 stamps=$work/hostile/clip.timestamps.csv
  mkdir -p "$work/hostile" "$work/images"
  cp "$work/clip/clip.mp4" "$clip"
  local checked=("$bin/hovermodald" --config "$work/clip/config.yaml" "${brief[@]}" --set "camera.source=$clip" --check)
  ln -s /dev/zero "$stamps"
  peak zero "${checked[@]}"
  refused f zero "device or pipe" 150 "clip.timestamps.csv -> /dev/zero"
  rm "$stamps" && mkfifo "$stamps"
  peak fifo "${checked[@]}"
  refused g fifo "device or pipe" 150 "clip.timestamps.csv is a pipe"
  rm "$stamps" && { printf 'frame,t_s\n0,' && head -c 300000000 /dev/zero | tr '\0' 1; } >"$stamps"
  peak line "${checked[@]}"
  refused h line "longer than 64 KiB" 150 "a line of 300 MB"
  rm "$stamps"
  python3 - "$work" <<'P'
import struct, sys, zlib
def chunk(name, data): return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
side, packer = 20000, zlib.compressobj(9)
pixels = b"".join(packer.compress(bytes(side + 1)) for _ in range(side)) + packer.flush()
header = struct.pack(">IIBBBBB", side, side, 8, 0, 0, 0, 0)
for k in range(2):
    with open(f"{sys.argv[1]}/images/{k}.png", "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", pixels) + chunk(b"IEND", b""))
with open(f"{sys.argv[1]}/sparse_run0001_000.lcm", "wb") as out:
    out.write(bytes.fromhex("eda1da01") + bytes(16) + struct.pack(">II", 1, 0x7FFFFFF0) + b"C")
    out.truncate(0x7FFFFFFF)
with open(f"{sys.argv[1]}/wide.csv", "w") as out:
    out.write("t," + ",".join(f"c{i}" for i in range(150)) + "\n")
    for k in range(6000):
        out.write(f"{k / 100}," + ",".join(str((k * 7919 + i * 104729) % 1009 / 1009) for i in range(150)) + "\n")
with open(f"{sys.argv[1]}/many.csv", "w") as out:
    out.write("# image_size_px: 480 x 270\n# rate_hz: 25\nframe,t_s,point,region,u_px,v_px,sigma_px\n")
    for i in range(50000):
        out.write(f"0,0,{i},base,1,1,0.1\n")
P
  peak png "$bin/hovermodald" --config "$work/clip/config.yaml" "${brief[@]}" --set "camera.source=$work/images" --set camera.rate_hz=25 --check
  refused i png "20000 x 20000" 150 "a PNG of 20000 x 20000 pixels"
  peak sparse "$bin/hovermodal" replay "$work/sparse_run0001_000.lcm"
  check j "exit code $code, $peak MB" "refused below 150 MB" "a sparse record with a length of 0x7ffffff0" "($code == 1 || $code == 2) && $peak < 150"
  peak wide bash -c "ulimit -v 4000000 && exec '$bin/hovermodal' identify --series '$work/wide.csv'"
  refused k wide "GB of memory are left" 300 "150 channels where 4 GB may be taken"
  peak segment "$bin/hovermodal" replay --tracks "$work/good/tracks.csv" --config "$work/clip/config.yaml" --set spectrum.segment=1048576
  check l "exit code $code, $peak MB, $(said segment bad_alloc) times std::bad_alloc" "refused in words, or done" "replay with a segment of 1048576" \
    "$(said segment bad_alloc) == 0 && ($code == 2 && $(said segment 'spectrum.segment') > 0 && $peak < 300)"
  peak points "$bin/hovermodal" replay --tracks "$work/many.csv" --config "$work/clip/config.yaml"
  refused m points "more than 4096 points" 150 "tracks of 50 000 points a region"
}

names() {
  local flights=$work/flights count
  mkdir -p "$flights"
  "$bin/hovermodal" simulate --scene "$work/scene.yaml" --tracks-only --points 15 --out "$flights/a" >/dev/null 2>&1
  ln -s .. "$flights/up" && ln -s . "$flights/here"
  local hostile=$flights/$'x\e[31m\u009b1m\u202egpj.mp4'
  touch "$hostile"
  peak batch "$bin/hovermodal" batch "$flights" --out "$work/together" --jobs 1
  count=$(find "$work/together/flights" -name modal.json | wc -l)
  check n "exit code $code, $count flights, links named $(said batch 'a link to a folder') times" "1 flight, both links named" "batch over links to . and .." \
    "$count == 1 && $(said batch 'a link to a folder') == 2"
  count=$(cat "$work/batch.log" "$work/together/batch.txt" | LC_ALL=C grep -cP '\x1b|\xc2\x9b|\xe2\x80\xae' || true)
  check o "$count lines with them, the file named $(said batch 'gpj.mp4') times" "0 lines, the file named" "a name with ESC, CSI and a mark of direction, on terminal and in batch.txt" \
    "$count == 0 && $(said batch gpj.mp4) > 0"
  service hostile --set "camera.source=$hostile"
  count=$(LC_ALL=C grep -cP '\x1b\[31m\xc2|\xc2\x9b|\xe2\x80\xae' "$work/hostile.log" || true)
  check p "$count lines with them, exit code $code" "0 lines, exit code 1, 2 or 3" "the same name in the service's log" "$count == 0 && $code >= 1 && $code <= 3"
}

signals() {
  local signal began
  for signal in TERM INT HUP; do
    ! skipped_hup q "$signal" || continue
    in_background "on_$signal" --report "$work/on_$signal"
    sleep 2
    began=$(date +%s%N)
    kill -"$signal" "$pid"
    ended 30
    took=$(awk "BEGIN { printf \"%.1f\", ($(date +%s%N) - $began) / 1e9 }")
    check "q.$signal" "exit code $code after $took s, report $([ -s "$work/on_$signal/report.html" ] && echo complete || echo missing)" \
      "exit code 0 within 5 s, a complete report" "SIG$signal ends a run" \
      "$code == 0 && $took < 5 && $([ -s "$work/on_$signal/report.html" ] && [ -s "$work/on_$signal/modal.json" ] && echo 1 || echo 0)"
  done
  service folds --set identification.max_frequency_hz=1e6
  check r "exit code $code after $took s, key named $(said folds identification.max_frequency_hz) times" "exit code 2 at the start" "identification.max_frequency_hz: 1e6" \
    "$code == 2 && $(said folds identification.max_frequency_hz) > 0 && $took < 5"
}

small_things() {
  local folder=$work/numbers before after victim=$work/victim option
  mkdir -p "$folder"
  touch "$folder/x_run99999999_000.lcm"
  service number_1 --set "record.directory=$folder"
  service number_2 --set "record.directory=$folder"
  check s "$(find "$folder" -name 'hovermodal_run*_000.lcm' | wc -l) records of two runs" "2" "a file x_run99999999_000.lcm in the folder" \
    "$(find "$folder" -name 'hovermodal_run*_000.lcm' -size +0 | wc -l) == 2"
  echo precious >"$victim"
  mkdir -p "$work/linked"
  for name in tracks.csv displacements.csv modal.json hovermodal.state; do ln -s "$victim" "$work/linked/$name.partial"; done
  ln -s "$work/flights" "$work/linked/report.partial"
  before=$(state_of "$work/flights")
  service linked --set "report.directory=$work/linked" --set "state.directory=$work/linked" --set state.period_s=5
  after=$(cat "$victim")
  check t "exit code $code, the file behind the links says \"$after\", the folder behind one $([ "$(state_of "$work/flights")" = "$before" ] && echo the same || echo changed)" "both untouched, exit code 0" \
    "links in the place of .partial files" "$code == 0 && \"$after\" == \"precious\" && \"$(state_of "$work/flights")\" == \"$before\""
  peak usage "$bin/hovermodal" replay --tracks "$work/good/tracks.csv" --config "$work/clip/config.yaml" --set spectrum.segment=3
  local of_replay=$code
  service usage_service --set spectrum.segment=3
  check u "replay's exit code $of_replay, the service's $code" "2 and 2" "a configuration that is refused" "$code == 2 && $of_replay == 2"
  local n=0
  for option in "--delays-ms nan" "--max-frequency nan" "--max-frequency inf" "--differences -1"; do
    # shellcheck disable=SC2086
    peak option "$bin/hovermodal" identify --series "$work/good/displacements.csv" $option
    [ "$code" -ne 2 ] || n=$((n + 1))
  done
  check v "$n of 4 refused" "4" "options of identify that are no numbers: nan, inf, -1 differences" "$n == 4"
}

figure_1() {
  inputs
  reports
  folders
  readers
  names
  signals
  small_things
  senders
  disks
  long_estimate
}
run_figures "${figures[@]}"

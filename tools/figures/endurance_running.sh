# Two parts of figure 1 of endurance.sh: two senders, and an estimate that takes long. Sourced by it.
# shellcheck shell=bash

# Two services with one stream_id on one group, and the spy: run in a network of its own.
senders() {
  local url="udpm://239.255.76.67:7667?ttl=0" out=$work/senders
  mkdir -p "$out"
  cat >"$out/run.sh" <<'R'
ip link set lo up && ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo
bin=$1 config=$2 out=$3 url=$4
"$bin/hovermodal" spy --url "$url" --plain --seconds 12 --count "$out/spy.json" >"$out/spy.log" 2>&1 &
spy=$!
for _ in $(seq 50); do grep -q "listening on" "$out/spy.log" && break; sleep 0.1; done
for n in 1 2; do
  "$bin/hovermodald" --config "$config" --set "telemetry.lcm_url=$url" --set closure.adopt=off --set camera.pace=realtime >"$out/service_$n.log" 2>&1 &
done
wait $spy
kill $(jobs -p) && wait
R
  unshare -rn bash "$out/run.sh" "$bin" "$work/clip/config.yaml" "$out" "$url" >"$out/run.log" 2>&1 || true
  local counted
  counted=$(python3 -c 'import json, sys
c = json.load(open(sys.argv[1]))
print(c["senders"], sum(c.get("other_senders", {}).values()), sum(t["restarts"] for t in c["channels"].values()), sum(t["received"] for t in c["channels"].values()))' \
    "$out/spy.json" 2>"$out/count.err") || counted="0 0 0 0"
  local n other restarts received
  read -r n other restarts received <<<"$counted"
  check w "$n senders named $(grep -c 'runs send as' "$out/spy.log" || true) times, $other messages of the second one counted, $restarts restarts in $received messages of the first" \
    "two senders told apart and named" "two services with one stream_id on one group, 12 s" \
    "$n == 2 && $other > 50 && $received > 50 && $restarts == 0 && $(grep -c 'runs send as' "$out/spy.log" || true) > 0"
}

# Block rows near the lags of a segment: an estimate that takes minutes.
long_estimate() {
  local signal began
  for signal in TERM INT HUP; do
    ! skipped_hup x "$signal" || continue
    in_background "long_$signal" --report "$work/long_$signal" --set spectrum.segment=512 --set identification.block_rows=200 \
      --set identification.period=1 --set camera.pace=as_fast_as_possible
    sleep 5
    began=$(date +%s%N)
    kill -"$signal" "$pid"
    ended 60
    took=$(awk "BEGIN { printf \"%.1f\", ($(date +%s%N) - $began) / 1e9 }")
    check "x.$signal" "exit code $code after $took s, report $([ -s "$work/long_$signal/report.html" ] && echo complete || echo missing), said $(said "long_$signal" 'did not end in time') times that an estimate is missing" \
      "exit code 0 within 5 s, a complete report" "SIG$signal during an estimate that takes minutes" \
      "$code == 0 && $took < 5 && $(said "long_$signal" 'did not end in time') > 0 && $([ -s "$work/long_$signal/report.html" ] && [ -s "$work/long_$signal/modal.json" ] && echo 1 || echo 0)"
  done
}

# A disk that is full for the report, then for the record.
disks() {
  local kind modes size
  for kind in report record; do
    size=700k
    [ "$kind" = record ] || size=6m # of which a report holds four for its smaller files
    mkdir -p "$work/full_$kind"
    code=0
    # shellcheck disable=SC2016
    unshare -rm sh -c 'folder=$1 && mount -t tmpfs -o size=$2 hm "$folder" && shift 2 && "$@"; code=$?; cp "$folder/modal.json" "$folder/../full_modal.json" 2>/dev/null; exit $code' sh \
      "$work/full_$kind" $size "$bin/hovermodald" --config "$work/clip/config.yaml" "${brief[@]}" --set "$kind.directory=$work/full_$kind" >"$work/full_$kind.log" 2>&1 || code=$?
    modes=$(number_of_modes "$work/full_modal.json")
    if [ "$kind" = report ]; then
      check y.report "exit code $code, tracks.csv named $(said full_report 'tracks.csv') times, modal.json with $modes modes" "exit code 1, the file named, modal.json whole" \
        "a disk that is full for tracks.csv" "$code == 1 && $(said full_report 'tracks.csv') > 0 && $modes > 0"
    else
      check y.record "exit code $code, what is missing in the record told $(said full_record 'are missing in the run record.*No space left') times" "told with its number and the disk" \
        "a disk that is full for the record" "$(said full_record 'are missing in the run record.*No space left') > 0"
    fi
  done
}

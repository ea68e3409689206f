# Shared by the figure scripts: where things are, one line a figure, small statistics. Source it from the project's root.
bin=build/release/bin
data=${HOVERMODAL_DATA:-../shared/data}
misses=0

# line NUMBER ok|MISS|SKIP "measured" "bar" "what"
line() {
  printf '%s %s %s (bar: %s) %s\n' "$1" "$2" "$3" "$4" "$5"
  [ "$2" != MISS ] || misses=$((misses + 1))
}

# judge NUMBER "measured" "bar" "what" AWK-CONDITION: ok when the condition holds, MISS when not or when it cannot be told:
# to awk a bare nan is a variable that is 0.
judge() {
  if [[ ! $5 =~ (^|[^[:alnum:]_\"])(nan|inf)($|[^[:alnum:]_\"]) ]] && awk "BEGIN { exit !($5) }" 2>/dev/null; then line "$1" ok "$2" "$3" "$4"; else line "$1" MISS "$2" "$3" "$4"; fi
}

# Median and worst (largest) of the numbers on standard input, "nan nan" when there are none.
median_and_worst() {
  sort -g | awk '{ v[NR] = $1 } END { if (NR == 0) print "nan nan"; else print (v[int((NR + 1) / 2)] + v[int(NR / 2) + 1]) / 2, v[NR] }'
}

# The run's own words only when it fails.
quietly() {
  local log
  log=$(mktemp)
  if ! "$@" >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    rm -f "$log"
    return 1
  fi
  rm -f "$log"
}

# The service's configuration for the filmed three-storey frame, on standard output.
knex_config() {
  cat <<Y
camera: {driver: file, source: "$data/knex_frame_video/knex_1300x2046_gray.mp4", rate_hz: 20}
regions:
  - {name: base, rect: [120, 1875, 1060, 70], role: base}
  - {name: floor1, rect: [120, 1385, 1030, 70]}
  - {name: floor2, rect: [120, 895, 1030, 70]}
  - {name: roof, rect: [120, 435, 1030, 70]}
spectrum: {segment: 128}
scale: {adaptive: false}
telemetry: {lcm_url: ""}
Y
}

# run_figures N...: figure_N of each, with the time it took; ends the script with 1 where a figure misses its bar.
run_figures() {
  local figure
  for figure in "$@"; do
    SECONDS=0
    "figure_$figure"
    echo "# figure $figure: $SECONDS s"
  done
  [ "$misses" -eq 0 ] || { echo "$misses figures miss their bar" >&2; exit 1; }
}

# Shared by the figure scripts: where things are, one line a figure, small statistics. Source it from the project's root.
bin=build/release/bin
data=${HOVERMODAL_DATA:-../shared/data}
misses=0

# line NUMBER ok|MISS|SKIP "measured" "bar" "what"
line() {
  printf '%s %s %s (bar: %s) %s\n' "$1" "$2" "$3" "$4" "$5"
  [ "$2" != MISS ] || misses=$((misses + 1))
}

# judge NUMBER "measured" "bar" "what" AWK-CONDITION: ok when the condition holds; MISS when not, when it cannot be told, and
# when one of its numbers is none: a word outside of quotes (nan, none) would count as 0.
judge() {
  local numbers
  numbers=$(sed -E 's/"[^"]*"//g; s/([0-9.])[eE]([-+]?[0-9])/\1\2/g' <<<"$5")
  if [[ ! $numbers =~ [[:alpha:]] ]] && awk "BEGIN { exit !($5) }" 2>/dev/null; then
    line "$1" ok "$2" "$3" "$4"
  else
    line "$1" MISS "$2" "$3" "$4"
  fi
}

# arguments "FIGURES" "$@": sets quick (yes or nothing), first (the first seed: 1001 unless --first-seed N says; 1-100 are for
# development) and figures (those named, or all of FIGURES). Whatever else ends the script.
arguments() {
  local known=" $1 "
  shift
  quick="" first=1001 figures=()
  while [ $# -gt 0 ]; do
    case $1 in
    --quick) quick=yes ;;
    --first-seed)
      [[ ${2:-} =~ ^[1-9][0-9]*$ ]] || { echo "${0##*/}: --first-seed is '${2:-}'; give a whole number from 1 on" >&2; exit 2; }
      first=$2
      shift
      ;;
    *)
      [[ $known == *" $1 "* ]] || { echo "${0##*/}: '$1' is none of its figures:$known" >&2; exit 2; }
      figures+=("$1")
      ;;
    esac
    shift
  done
  [ "${#figures[@]}" -gt 0 ] || read -ra figures <<<"$known"
}
seeds_of() { echo "seeds $first-$((first + $1 - 1))"; }  # NUMBER OF SEEDS, in words

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

# run_figures N...: figure_N of each, with the time it took; ends the script with 1 where a figure misses its bar. Of
# "N-drawn" figure_N with `drawn` set to "-drawn": camera, structure and noise from the seed as far as the figure lets them.
run_figures() {
  local figure
  for figure in "$@"; do
    SECONDS=0 drawn=""
    [ "$figure" = "${figure%-drawn}" ] || drawn=-drawn
    "figure_${figure%-drawn}"
    echo "# figure $figure: $SECONDS s"
  done
  [ "$misses" -eq 0 ] || { echo "$misses figures miss their bar" >&2; exit 1; }
}

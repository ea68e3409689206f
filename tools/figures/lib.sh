# Shared by the figure scripts: where things are, one line a figure, small statistics. Source it from the project's root.
bin=build/release/bin
# Measured data: HOVERMODAL_DATA, else ../shared/data where it exists, else data in the project, where tools/data.sh puts them.
data=${HOVERMODAL_DATA:-}
if [ -z "$data" ]; then data=$([ -d ../shared/data ] && echo ../shared/data || echo ./data); fi
misses=0

# line NUMBER ok|MISS|SKIP "measured" "bar" "what"; a SKIP that names a place in $data says what brings it.
line() {
  local remedy=
  if [ "$2" = SKIP ] && [[ "$3 $5" == *"$data"* ]]; then remedy=" (tools/data.sh brings it)"; fi
  printf '%s %s %s (bar: %s) %s\n' "$1" "$2" "$3" "$4" "$5$remedy"
  [ "$2" != MISS ] || misses=$((misses + 1))
}

# finish_figures: the last command of every script. It says that the run came to its end, which alone makes it a result
# (tools/figures/all.sh), and exits with 1 where a figure misses its bar.
finish_figures() {
  echo "# whole: $misses figures miss their bar"
  [ "$misses" -eq 0 ] || exit 1
}

# judge NUMBER "measured" "bar" "what" AWK-CONDITION: ok when the condition holds, MISS when not or when it cannot be told.
# To awk a bare word such as nan or inf is an unset variable, and less than any bar.
judge() {
  local bare
  bare=$(sed -E 's/"[^"]*"//g' <<<"$5")
  if [[ ! ${bare,,} =~ (^|[^a-z0-9_])(nan|inf|none|never)([^a-z0-9_]|$) ]] && awk "BEGIN { exit !($5) }" 2>/dev/null </dev/null; then
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

# A figure that the script did not reach the end of is a miss, whatever stopped it. clean_up: of the script's own, if it has one.
unfinished=()
tell_unfinished() {
  local figure
  for figure in "${unfinished[@]}"; do line "$figure" MISS "it did not come to its end" "to come to its end" "figure $figure"; done
  ! declare -F clean_up >/dev/null || clean_up
}

# run_figures N...: figure_N of each, with the time it took; then after_figures, if the script has one, and finish_figures.
# Of "N-drawn" figure_N with `drawn` set to "-drawn": camera, structure and noise from the seed as far as the figure lets them.
run_figures() {
  local figure
  unfinished=("$@")
  trap tell_unfinished EXIT
  trap 'exit 143' TERM INT
  for figure in "$@"; do
    SECONDS=0 drawn=""
    [ "$figure" = "${figure%-drawn}" ] || drawn=-drawn
    "figure_${figure%-drawn}"
    echo "# figure $figure: $SECONDS s"
    unfinished=("${unfinished[@]:1}")
  done
  ! declare -F after_figures >/dev/null || after_figures
  finish_figures
}

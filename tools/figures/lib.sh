# Shared by the figure scripts: paths, one line per figure, small statistics. Source it from the project's root.
bin=build/release/bin
# Measured data: HOVERMODAL_DATA, else ../shared/data where it exists, else data in the project, where tools/data.sh puts them.
data=${HOVERMODAL_DATA:-}
if [ -z "$data" ]; then data=$([ -d ../shared/data ] && echo ../shared/data || echo ./data); fi
misses=0

# line NUMBER ok|MISS|SKIP "measured" "bar" "what"; a SKIP for missing data in $data also names the command that fetches them.
line() {
  local remedy=
  if [ "$2" = SKIP ] && [[ "$3 $5" == *"$data"* ]]; then remedy=" (tools/data.sh brings it)"; fi
  printf '%s %s %s (bar: %s) %s\n' "$1" "$2" "$3" "$4" "$5$remedy"
  [ "$2" != MISS ] || misses=$((misses + 1))
}

# finish_figures: the last command of every script. It states that the run reached its end, which is required for a result
# (tools/figures/all.sh), and exits with 1 where a figure misses its bar.
finish_figures() {
  echo "# whole: $misses figures miss their bar"
  [ "$misses" -eq 0 ] || exit 1
}

# judge NUMBER "measured" "bar" "what" AWK-CONDITION: ok if the condition holds, MISS if not or if it cannot be evaluated.
# In awk a bare word such as nan or inf would be an unset variable, which is less than any bar.
judge() {
  local bare
  bare=$(sed -E 's/"[^"]*"//g' <<<"$5")
  if [[ ! ${bare,,} =~ (^|[^a-z0-9_])(nan|inf|none|never)([^a-z0-9_]|$) ]] && awk "BEGIN { exit !($5) }" 2>/dev/null </dev/null; then
    line "$1" ok "$2" "$3" "$4"
  else
    line "$1" MISS "$2" "$3" "$4"
  fi
}

# Arguments of a figure script:
#   take_arguments USAGE "$@"     USAGE names the options that the script has, of [--quick] [--seeds N] [--first-seed N] [FIGURE...]
# quick: yes or empty; n_seeds: as given, or empty; first_seed: the first seed of all random draws (1001; 1 - 100 are
# for development); figures: as named; handed_on: the options, for another figure script. Other arguments end the script.
usage='' quick='' n_seeds='' first_seed=1001 seed_given='' figures=() handed_on=()

refuse() { # TEXT...
  echo "$(basename "$0"): $*" >&2
  exit 2
}

take_arguments() {
  usage=$1
  shift
  while [ $# -gt 0 ]; do
    [[ $1 != --[a-z]* || $1 == --help || "$usage " == *"[$1"[\]\ ]* ]] || refuse "$1: unknown; usage: $usage"
    case $1 in
      --quick) quick=yes ;;
      --seeds | --first-seed)
        [[ ${2:-} =~ ^[0-9]{1,9}$ && $((10#$2)) -gt 0 ]] || refuse "$1: expected a whole number from 1 on, got \"${2:-}\""
        if [ "$1" = --seeds ]; then n_seeds=$((10#$2)); else first_seed=$((10#$2)) seed_given=yes; fi
        shift
        ;;
      -h | --help) echo "usage: $usage" && exit 0 ;;
      -*) refuse "$1: unknown; usage: $usage" ;;
      *) figures+=("$1") ;;
    esac
    shift
  done
  handed_on=(${quick:+--quick} ${seed_given:+--first-seed "$first_seed"})
}

# all_or_named ALL...: all figures if none is named; an unknown name ends the script.
all_or_named() {
  local figure
  [ ${#figures[@]} -gt 0 ] || figures=("$@")
  for figure in "${figures[@]}"; do
    [[ " $* " == *" $figure "* ]] || refuse "$figure: there are $*; usage: $usage"
  done
}

# draws FIGURE...: the figures that draw at random. A first seed is refused if none of them is requested.
draws() {
  local figure
  [ -n "$seed_given" ] || return 0
  for figure in "${figures[@]}"; do
    [[ " $* " != *" $figure "* ]] || return 0
  done
  refuse "--first-seed: nothing is drawn at random in ${figures[*]}${1:+; it is in $*}"
}
seeds_of() { echo "seeds $first_seed-$((first_seed + $1 - 1))"; }  # NUMBER OF SEEDS, as text

# set_up OPTION...: tools/setup.sh; if packages are missing and cannot be installed, prints a SKIP for each figure and ends.
set_up() {
  local figure
  ! quietly tools/setup.sh "$@" || return 0
  for figure in "${figures[@]}"; do
    line "$figure" SKIP "packages are missing" "-" "figure $figure; they are installed by: tools/setup.sh${*:+ $*}, as root"
  done
  finish_figures
  exit 0
}

# run_script SCRIPT ARGUMENT...: another figure script, as a part of this one; finish_scripts: replaces finish_figures.
scripts_cut_off=0
run_script() {
  local status
  "$@" | awk '/^# whole: / { whole = 1; next } { print; fflush() } END { exit !whole }'
  status=("${PIPESTATUS[@]}")
  [ "${status[1]}" -eq 0 ] || scripts_cut_off=$((scripts_cut_off + 1))
  [ "${status[0]}" -eq 0 ] || misses=$((misses + 1))
}
finish_scripts() {
  [ $scripts_cut_off -eq 0 ] || { echo "$scripts_cut_off figures did not come to their end" >&2 && exit 1; }
  finish_figures
}

# cells FILE NAME COLUMNS: the lines of a table (cells separated by tabs) whose first cell is NAME, grouped by these columns
# (numbers from 0, separated by commas). The Python on standard input is run for each group: `key`, the group's cells; `rows`, its
# lines; column(i), its numbers that are not nan; middle(i), their median; put(...), which prints a line.
cells() {
  python3 -c '
import collections, math, statistics, sys
path, name, columns = sys.argv[1:]
groups, body = collections.OrderedDict(), compile(sys.stdin.read(), "cells", "exec")
with open(path, encoding="utf-8") as table:
    for cells in (line.rstrip("\n").split("\t") for line in table):
        if cells[0] == name:
            groups.setdefault(tuple(cells[int(c)] for c in columns.split(",")), []).append(cells)
def put(*words):
    print(*words, sep="\t")
for key, rows in groups.items():
    def column(i):
        return [float(r[i]) for r in rows if not math.isnan(float(r[i]))]
    def middle(i):
        return statistics.median(column(i)) if column(i) else float("nan")
    exec(body, {"collections": collections, "math": math, "statistics": statistics, "put": put,
                "key": key, "rows": rows, "column": column, "middle": middle})
' "$@"
}

# Median and worst (largest) of the numbers on standard input, "nan nan" if there are none.
median_and_worst() {
  sort -g | awk '{ v[NR] = $1 } END { if (NR == 0) print "nan nan"; else print (v[int((NR + 1) / 2)] + v[int(NR / 2) + 1]) / 2, v[NR] }'
}

# Prints the run's output only when it fails.
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

# A figure whose script did not reach its end is a MISS, whatever stopped it. clean_up: defined by the script, if needed.
unfinished=()
tell_unfinished() {
  local figure
  for figure in "${unfinished[@]}"; do line "$figure" MISS "it did not come to its end" "to come to its end" "figure $figure"; done
  ! declare -F clean_up >/dev/null || clean_up
}

# run_figures N...: figure_N of each, with the time it took; then after_figures, if the script has one, and finish_figures.
# For "N-drawn", figure_N with `drawn` set to "-drawn": camera, structure and noise from the seed unless fixed by the figure.
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

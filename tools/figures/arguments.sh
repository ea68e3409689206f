# What the figure scripts are asked: source it after lib.sh, then
#   take_arguments USAGE "$@"     [--quick] [--first-seed N] [FIGURE...]
# quick: yes or empty; first_seed: from which on whatever is random is drawn (1 - 100 are for development); figures: as named;
# handed_on: the options, for another figure script.
usage='' quick='' first_seed=1001 seed_given='' figures=() handed_on=()

refuse() { # TEXT...
  echo "$(basename "$0"): $*" >&2
  exit 2
}

take_arguments() {
  usage=$1
  shift
  while [ $# -gt 0 ]; do
    case $1 in
      --quick) quick=yes ;;
      --first-seed)
        [[ ${2:-} =~ ^[0-9]{1,9}$ ]] || refuse "--first-seed: a whole number from 0 belongs behind it, not \"${2:-}\""
        first_seed=$((10#$2)) seed_given=yes
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

# all_or_named ALL...: without names all; a name that is none of them is refused.
all_or_named() {
  local figure
  [ ${#figures[@]} -gt 0 ] || figures=("$@")
  for figure in "${figures[@]}"; do
    [[ " $* " == *" $figure "* ]] || refuse "$figure: there are $*; usage: $usage"
  done
}

# draws FIGURE...: these draw something. A first seed is refused where none of them is asked for.
draws() {
  local figure
  [ -n "$seed_given" ] || return 0
  for figure in "${figures[@]}"; do
    [[ " $* " != *" $figure "* ]] || return 0
  done
  refuse "--first-seed: nothing is drawn at random in ${figures[*]}${1:+; it is in $*}"
}

# set_up OPTION...: tools/setup.sh; where packages are missing and cannot be installed, a SKIP for each figure, and the end.
set_up() {
  local figure
  ! quietly tools/setup.sh "$@" || return 0
  for figure in "${figures[@]}"; do
    line "$figure" SKIP "packages are missing" "-" "figure $figure; they are installed by: tools/setup.sh${*:+ $*}, as root"
  done
  finish_figures
  exit 0
}

# run_script SCRIPT ARGUMENT...: another figure script, as a part of this one; finish_scripts: in the place of finish_figures.
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

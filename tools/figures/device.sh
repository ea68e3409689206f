# Figures that come from cases in the virtual machine (tests/device/run.sh). Sourced by cameras.sh and platforms.sh, after
# lib.sh.

# outcomes NUMBER WHERE [VARIABLE=VALUE...] -- run.sh's arguments: a figure's line for each outcome
outcomes() {
  local number=$1 where=$2 i=0 n=0 verdict what measured bar variables=()
  shift 2
  while [ "$1" != -- ]; do variables+=("$1") && shift; done
  shift
  while IFS=$'\t' read -r verdict what measured bar; do
    i=$((i + 1))
    case $verdict in
      ok | MISS) n=$((n + 1)) && line "$number.$i" "$verdict" "$measured" "$bar" "$what$where" ;;
    esac
  done < <(env "${variables[@]}" tests/device/run.sh "$@" 2>&1 || true)
  [ $n -gt 0 ] || line "$number" MISS "nothing" "outcomes" "tests/device/run.sh $*"
}

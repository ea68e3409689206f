#!/usr/bin/env bash
# Runs the figure scripts part by part and keeps what they printed in tools/figures/results/PART.txt.
#   tools/figures/all.sh [--again] [PART...]     default: every part of tools/figures/parts.tsv without a valid result
#   tools/figures/all.sh --list                  parts, expected minutes, and the state of their results
# It resumes: a part whose result was made from the present rooms (the files that it measures) is left as it is, unless
# --again asks for it. A run counts only if it came to its end and its rooms are committed and did not change meanwhile.
# Parts take from seconds to hours; those that measure time want the machine for themselves.
# Afterwards: tools/figures/tables.py --write puts the results into the documents' tables.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
again=no
case ${1:-} in
  --list) exec python3 tools/figures/tables.py --list ;;
  --again) again=yes && shift ;;
  -h | --help) sed -n '2,8s/^# \{0,1\}//p' "$0" && exit 0 ;;
  -*) echo "all: $1: unknown option; --help lists them" >&2 && exit 2 ;;
esac
results=tools/figures/results
logs=build/figures/all
mkdir -p "$results" "$logs"

part_field() { awk -F'\t' -v name="$1" -v column="$2" '$1 == name { print $column }' tools/figures/parts.tsv; }
processor() { awk -F': *' '/^model name/ { name = $2 } END { print name != "" ? name : "unknown" }' /proc/cpuinfo; }
load() { cut -d' ' -f1 /proc/loadavg; }
digests() { python3 tools/figures/tables.py --rooms "$1"; } # one "# room: NAME DIGEST" line a room
data_there() { # prints which sets of measured data exist
  local sets
  sets=$(cd "$data" 2>/dev/null && find . -mindepth 1 -maxdepth 1 -type d -printf '%f\n' | sort | tr '\n' ' ') || true
  echo "${sets:-none}"
}

# run_part NAME: its result, or a message why there is none. 0: a result without MISS, 1: with MISS, 2: no result.
run_part() {
  local name=$1 command rooms before started log=$logs/$1.log code=0 start_load commit
  command=$(part_field "$name" 4) before=$(digests "$name")
  rooms=$(sed 's/^# room: //; s/ [^ ]*$//' <<<"$before")
  # shellcheck disable=SC2086 -- rooms are several words
  if [ -n "$(git status --porcelain -- $rooms)" ]; then
    echo "  $name: not run: its rooms have changes that are not committed (git status -- $rooms)" >&2
    return 2
  fi
  commit=$(git rev-parse HEAD) start_load=$(load) started=$SECONDS
  bash -c "$command" >"$log" 2>&1 || code=$?
  if ! grep -q '^# whole: ' "$log" || [ "$code" -gt 1 ]; then
    echo "  $name: no result: '$command' did not come to its end (exit code $code); see $log" >&2
    return 2
  fi
  if [ "$before" != "$(digests "$name")" ]; then
    echo "  $name: no result: its rooms changed while it ran; run it again" >&2
    return 2
  fi
  {
    printf '# part: %s\n# command: %s\n# commit: %s\n# date: %s\n' "$name" "$command" "$commit" "$(date -u +%Y-%m-%d)"
    printf '# processor: %s, %s processors\n# load: %s before, %s after\n' "$(processor)" "$(nproc)" "$start_load" "$(load)"
    printf '# seconds: %s\n# measured data: %s\n%s\n# whole: yes\n' "$((SECONDS - started))" "$(data_there)" "$before"
    grep -E '^(\S+ (ok|MISS|SKIP|beside) |\||#)' "$log" | grep -v '^# whole: ' | sed "s|$PWD/||g"
  } >"$results/$name.txt.new"
  mv "$results/$name.txt.new" "$results/$name.txt"
  grep -E '^\S+ MISS ' "$log" | sed 's/^/  /' || true
  return "$code"
}

parts=("$@")
if [ ${#parts[@]} -eq 0 ]; then mapfile -t parts < <(grep -v '^#' tools/figures/parts.tsv | cut -f1 | grep .); fi
for name in "${parts[@]}"; do
  [ -n "$(part_field "$name" 4)" ] || { echo "all: $name: no such part; --list shows them" >&2 && exit 2; }
done
n=0 missed=0 none=0
for name in "${parts[@]}"; do
  n=$((n + 1))
  if [ $again = no ] && python3 tools/figures/tables.py --valid "$name"; then
    echo "[$n/${#parts[@]}] $name: result is valid, left as it is"
    continue
  fi
  echo "[$n/${#parts[@]}] $name: $(part_field "$name" 5), some $(part_field "$name" 2) min"
  code=0
  run_part "$name" || code=$?
  case $code in 0) ;; 1) missed=$((missed + 1)) ;; *) none=$((none + 1)) ;; esac
done
echo "$n parts: $missed with a MISS, $none without a result; now: tools/figures/tables.py --write"
[ $((missed + none)) -eq 0 ]

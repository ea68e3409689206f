#!/usr/bin/env bash
# Whether bash completes what the programs' --help lists: every subcommand, and every option of each. Prints a line a
# command, "ok COMMAND: N words", and "missing COMMAND: WORD" for what is not offered; then the exit status is 1.
#   tools/package/completion_check.sh     the completion of this tree, for the programs that are in the PATH
#   (. tools/package/completion_check.sh FILE BEFORE)    of FILE; BEFORE: a function of the caller, which runs programs elsewhere
set +e -uo pipefail
. "${1:-$(dirname "${BASH_SOURCE[0]}")/completion.bash}"
runner=${2:-}
if [ -n "$runner" ]; then
  hovermodal() { "$runner" hovermodal "$@"; }
  hovermodald() { "$runner" hovermodald "$@"; }
fi
compopt() { :; } # only within a real completion

offered() { # WORD...: what is offered in place of the last one
  COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
  _hovermodal "$1" "${!#}" "${COMP_WORDS[COMP_CWORD - 1]}"
  printf '%s\n' "${COMPREPLY[@]}"
}

check() { # COMMAND...
  local help told words n=0 word
  help=$("$@" --help 2>/dev/null)
  words=$(offered "$@" -; offered "$@" "")
  # Read otherwise than the completion does it.
  told=$(grep -oE '^  (-[a-zA-Z]|--[a-z-]+)(,--[a-z-]+)?' <<<"$help" | tr ',' '\n' | tr -d ' ')
  told+=" $(sed -n '/^Subcommands:$/,$p' <<<"$help" | grep -oE '^  [a-z]+' | tr -d ' ')"
  for word in $told; do
    n=$((n + 1))
    grep -qxF -- "$word" <<<"$words" || { echo "missing $*: $word" && n_missing=$((n_missing + 1)); }
  done
  echo "ok $*: $n words"
  for word in $(sed -n '/^Subcommands:$/,$p' <<<"$help" | grep -oE '^  [a-z]+' | tr -d ' '); do check "$@" "$word"; done
}
n_missing=0
check hovermodald
check hovermodal
[ $n_missing -eq 0 ]

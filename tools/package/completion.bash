# Completion for hovermodal and hovermodald: asks the program itself (--help), so that it always fits what is installed.
declare -gA _hovermodal_told

# _hovermodal_ask PROGRAM ARG...: what it prints, in REPLY; asked once a shell.
_hovermodal_ask() {
  local key="$*"
  [[ -n ${_hovermodal_told[$key]+set} ]] || _hovermodal_told[$key]=$("$@" 2>/dev/null)
  REPLY=${_hovermodal_told[$key]}
}

_hovermodal() {
  local program=${COMP_WORDS[0]} word=$2 previous=$3 i help words commands=() REPLY
  _hovermodal_ask "$program" --help
  help=$REPLY
  for ((i = 1; i < COMP_CWORD; i++)); do
    [[ ${COMP_WORDS[i]} =~ ^[a-z-]+$ ]] || continue
    awk -v name="${COMP_WORDS[i]}" '/^[A-Za-z].*:$/ { on = $0 == "Subcommands:" } on && $0 ~ "^  " name "( |$)" { found = 1 } END { exit !found }' <<<"$help" || continue
    commands+=("${COMP_WORDS[i]}")
    _hovermodal_ask "$program" "${commands[@]}" --help
    help=$REPLY
  done

  # The key of --set, the value of an option that has a list of them, options, or subcommands; else files (-o default).
  if [[ $previous == --set && $program == *hovermodald ]]; then
    _hovermodal_ask "$program" --help-config
    words=$(awk '/^EVERY KEY/ { on = 1 } on && /^[a-z]+(\.[a-z_.]+)? / { print $1 "=" }' <<<"$REPLY")
    compopt -o nospace
  elif [[ $previous == --* ]] && words=$(sed -nE "s/^  (-., ?)?$previous [A-Za-z|]*:\{([^}]*)\}.*/\2/p" <<<"$help") && [[ -n $words ]]; then
    words=${words//,/ }
  elif [[ $word == -* ]]; then
    words=$(grep -oE '^  -[^ ]*' <<<"$help" | tr ',' '\n' | tr -d ' ')
  elif [[ $previous != -* || $previous == "$program" ]]; then
    words=$(awk '/^[A-Za-z].*:$/ { on = $0 == "Subcommands:"; next } on && /^  [a-z]/ { print $1 }' <<<"$help")
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
}
complete -o default -F _hovermodal hovermodal hovermodald

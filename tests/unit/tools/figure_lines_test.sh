#!/usr/bin/env bash
# What every figure script relies on (tools/figures/lib.sh): which measurements pass, and which arguments are
# refused. One line an expectation, exit code 1 where one fails.
set -uo pipefail
cd "$(dirname "$0")/../../.."
failed=0
expect() { # WHAT EXPECTED GOT
  if [ "$2" = "$3" ]; then echo "ok $1"; else echo "FAILED $1: \"$3\" instead of \"$2\"" && failed=1; fi
}
in_script() { bash -c "set -euo pipefail; . tools/figures/lib.sh; $1" script "${@:2}" 2>&1; }
verdict() { in_script "judge 1 m b w '$1'" | cut -d' ' -f2; }

expect "a bar that is met passes" ok "$(verdict '1e-13 <= 1e-12 && 3 > 2')"
expect "a bar that is not met is a miss" MISS "$(verdict '2e-12 <= 1e-12')"
expect "nan is no pass" MISS "$(verdict 'nan < 3')"
expect "inf is no pass" MISS "$(verdict 'inf <= 1e-12')"
expect "minus nan is no pass" MISS "$(verdict '-nan < 3')"
expect "nothing is no pass" MISS "$(verdict ' < 3')"
expect "a word in quotes may say nan" ok "$(verdict '"nan" != "x" && 1 < 2')"
expect "a figure that failed is a miss, and so are those behind it" "1 2" \
  "$(in_script 'figure_1() { false; }; figure_2() { :; }; run_figures 1 2' | awk '$2 == "MISS" { printf "%s%s", sep, $1; sep = " " }')"
expect "a figure that ended is no miss for the next one" "2" \
  "$(in_script 'figure_1() { :; }; figure_2() { exit 3; }; run_figures 1 2' | awk '$2 == "MISS" { printf "%s%s", sep, $1; sep = " " }')"
arguments='take_arguments "U [--quick] [--first-seed N] [FIGURE...]" "$@"; all_or_named 1 2 3; draws 2; echo "$quick,$first_seed,${figures[*]},${handed_on[*]}"'
expect "seeds begin at 1001, figures with all" ",1001,1 2 3," "$(in_script "$arguments")"
expect "a first seed and figures are taken" "yes,7,2 3,--quick --first-seed 7" "$(in_script "$arguments" --quick --first-seed 007 2 3)"
for wrong in "--first-seed" "--first-seed -1" "--first-seed 0" "--first-seed 1.5" "--first-seed 3 1" "4" "--fast" "--seeds 3"; do
  # shellcheck disable=SC2086
  in_script "$arguments" $wrong >/dev/null
  expect "refused: $wrong" 2 $?
done
expect "a seed without a draw is refused in words" 1 "$(in_script "$arguments" --first-seed 3 1 | grep -c 'nothing is drawn at random in 1')"
expect "a number of seeds is taken where the usage has it" "5" "$(in_script 'take_arguments "U [--seeds N]" "$@"; echo "$n_seeds"' --seeds 5)"
table=$(mktemp)
trap 'rm -f "$table"' EXIT
printf 'a\tx\t1\nother\tx\t9\na\ty\tnan\na\tx\t4\na\ty\t6\n' >"$table"
expect "the lines of a table are grouped, nan left out of the median" "x 2 2.5;y 2 6.0;" \
  "$(in_script "cells $table a 1 <<<'put(*key, len(rows), middle(2))'" | tr '\t\n' ' ;')"
expect "a table without such lines has no groups" "" "$(in_script "cells $table b 1 <<<'put(*key)'")"
exit $failed

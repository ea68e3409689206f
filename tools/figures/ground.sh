#!/usr/bin/env bash
# The ground side: the page, records and replays, LCM's own tools, a bad link, hostile packets and requests. One line a
# figure; half an hour on two processors, --quick: ten minutes.
#   tools/figures/ground.sh [--quick] [--first-seed N] [FIGURE...]
#                                                      FIGURE: 1 and 2 (the page), 3 (replay), 4 (lcm-spy), 5 (a bad link),
#                                                      6 (hostile packets), 6h (hostile requests), 7 (regions proposed), 7p (their page)
set -uo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/ground.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
all_or_named 1 2 3 4 5 6 6h 7 7p
draws 1 3 4 5 6 6h 7 7p
for figure in "${figures[@]}"; do
  case $figure in
    1 | 2 | 6h | 7p) script=ground_page ;;
    3) script=ground_record ;;
    *) script=ground_link ;;
  esac
  more=("${handed_on[@]}")
  [ "$figure" != 2 ] || more=(${quick:+--quick}) # draws nothing at random
  run_script "tools/figures/$script.sh" "${more[@]}" "$figure"
done
finish_scripts

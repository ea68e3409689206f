#!/usr/bin/env bash
# What ships: packages, the service under systemd, hostile inputs, batches of flights, documents. One line a figure; hours on
# two processors, --quick: about one.
#   tools/figures/shipping.sh [--quick] [--first-seed N] [FIGURE...]
#                                                        FIGURE: 1 (packages), 2 (the service), 3 (fuzzing), 4 (batches),
#                                                        5 (documents); default: all
set -uo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/shipping.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
all_or_named 1 2 3 4 5
draws 1 3 4
scripts=(_ packages service fuzz batch docs)
for figure in "${figures[@]}"; do
  more=("${handed_on[@]}")
  [[ $figure != [25] ]] || more=(${quick:+--quick}) # these draw nothing at random
  run_script "tools/figures/shipping_${scripts[figure]}.sh" "${more[@]}"
done
finish_scripts

#!/usr/bin/env bash
# What ships: packages, the service under systemd, hostile inputs, batches of flights, documents. One line a figure; hours on
# two processors, --quick: about one.
#   tools/figures/shipping.sh [--quick] [FIGURE...]      FIGURE: 1 (packages), 2 (the service), 3 (fuzzing), 4 (batches),
#                                                        5 (documents); default: all
set -uo pipefail
cd "$(dirname "$0")/../.."
quick=()
[ "${1:-}" != --quick ] || { quick=(--quick) && shift; }
figures=("$@")
[ $# -gt 0 ] || figures=(1 2 3 4 5)
scripts=(_ packages service fuzz batch docs)
failed=0
for figure in "${figures[@]}"; do
  case $figure in
    [1-5]) "tools/figures/shipping_${scripts[figure]}.sh" "${quick[@]}" || failed=1 ;;
    *) echo "shipping: $figure: 1 to 5" >&2; exit 2 ;;
  esac
done
exit $failed

# Figures 2 and 3 of exchange.sh, which sources this: compare --sensor.
# shellcheck shell=bash

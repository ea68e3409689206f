#!/usr/bin/env bash
# Everything that must pass: builds, then unit, property, golden, measured, integration, short stress and fuzz tests.
#   tools/test.sh [ctest arguments]      e.g. tools/test.sh -L unit
set -euo pipefail
cd "$(dirname "$0")/.."
tools/setup.sh
tools/build.sh
# LCM's tests send to a multicast address on this machine only; without a route for it nothing arrives.
if [ "$(id -u)" -eq 0 ] && command -v ip >/dev/null && ! ip route show table all | grep -q '^multicast\|^224\.'; then
  ip route add 224.0.0.0/4 dev lo 2>/dev/null || true
fi
ctest --test-dir build/release --output-on-failure -j "$(nproc)" "$@"

#!/usr/bin/env bash
# Configures and builds build/release; does nothing when nothing changed. Arguments: targets (default: all).
set -euo pipefail
cd "$(dirname "$0")/.."
if [ ! -f build/release/build.ninja ]; then
  cmake --preset release >build-configure.log 2>&1 || { cat build-configure.log >&2; rm -f build-configure.log; exit 1; }
  rm -f build-configure.log
fi
targets=()
[ $# -eq 0 ] || targets=(--target "$@")
if [ -t 1 ]; then
  cmake --build build/release "${targets[@]}"
else
  log=build/release/build.log
  cmake --build build/release "${targets[@]}" >"$log" 2>&1 || { grep -E -A12 'error|FAILED' "$log" | head -n 80 >&2; exit 1; }
  tail -n 1 "$log"
fi

#!/usr/bin/env bash
# The camera drivers against real kernel drivers, in a virtual machine (tests/device/guest.sh). One line an outcome.
#   tests/device/run.sh [--kernel standard|rt] [--icount] [CASE...]     CASE: of tests/device/cases (default: all but latency)
# Exit status 77 where there is no machine emulator or no kernel for it (tools/setup.sh --device fetches both).
# HOVERMODAL_BIN: folder of the programs, build/release/bin by default.
set -euo pipefail
cd "$(dirname "$0")/../.."
kernel=standard machine=()
[ "${1:-}" != --kernel ] || { kernel=$2 && shift 2; }
[ "${1:-}" != --icount ] || { machine=(--icount) && shift; }
cases=("$@")
[ $# -gt 0 ] || cases=(formats multiplanar usb faults replug contract libcamera service)
command -v qemu-system-x86_64 >/dev/null || { echo "device tests: skipped, no qemu-system-x86_64 (tools/setup.sh --device)"; exit 77; }
[ -d "${HOVERMODAL_VM:-build/device}/kernel" ] || { echo "device tests: skipped, no kernel for the virtual machine (tools/setup.sh --device)"; exit 77; }
export HOVERMODAL_BIN=${HOVERMODAL_BIN:-build/release/bin}
mkdir -p build/device
failed=0
for name in "${cases[@]}"; do
  case $name in
    contract | libcamera) tests/device/vimc.sh "$kernel" ;;
    service) tests/device/clip.sh ;;
  esac
  out=build/device/out/$name
  rm -rf "$out"
  variables=()
  for variable in HOVERMODAL_BIN FORMATS SIZES FRAMES RATE TIMES WATCH_S CLIP_RATE MOST_KIB ASAN_OPTIONS UBSAN_OPTIONS; do
    [ -z "${!variable:-}" ] || variables+=("$variable=${!variable}")
  done
  if tests/device/guest.sh --kernel "$kernel" --out "$out" --timeout "${LIMIT_S:-900}" "${machine[@]}" env "${variables[@]}" "tests/device/cases/$name.sh" >"build/device/$name.log" 2>&1; then
    status=0
  else
    status=$?
  fi
  grep -aE $'^(ok|MISS|figure)\t' "build/device/$name.log" || status=$((status > 1 ? status : 125))
  # 1: the case missed a bar and printed it.
  [ $status -le 1 ] || printf 'MISS\t%s\tended with status %s\tto come to its end\n' "$name" "$status"
  [ $status -eq 0 ] || { echo "device: $name ended with status $status; its log is build/device/$name.log" >&2 && failed=1; }
done
exit $failed

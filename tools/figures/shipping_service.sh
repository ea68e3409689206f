#!/usr/bin/env bash
# The service under systemd: its exposure, and a Debian with the packages booted in a virtual machine (tests/device/guest.sh),
# on the standard kernel and on PREEMPT_RT: ready, real-time, watchdog, crash, stop. One line a figure; a quarter of an hour
# without KVM. --quick: the standard kernel only. Needs root, as figure 1 does, which makes that Debian where it is missing.
#   tools/figures/shipping_service.sh [--quick]
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
kernels=(standard rt)
[ "${1:-}" != --quick ] || kernels=(standard)
root=$PWD/build/figures/shipping/root

score=$(systemd-analyze security --offline=true firmware_app/service/hovermodald.service 2>/dev/null | sed -n 's/.*exposure level.*: \([0-9.]*\).*/\1/p' || true)
judge 2.exposure "${score:-none}" "<= 2.5" "systemd-analyze security --offline=true" "${score:-99} <= 2.5"

[ "$(id -u)" -eq 0 ] || { line 2 SKIP "not root" "root" "a Debian of its own to boot"; exit 0; }
tools/setup.sh --device
if [ ! -x "$root/lib/systemd/systemd" ] || [ ! -x "$root/usr/bin/hovermodald" ]; then
  tools/figures/shipping_packages.sh --quick build install
fi
quietly tools/build.sh hold_thread
for kernel in "${kernels[@]}"; do
  out=build/figures/shipping/guest-$kernel
  rm -rf "$out"
  mkdir -p "$out"
  cp tests/device/cases/systemd.sh tests/device/cases/lib.sh "$bin/hold_thread" "$out/"
  quietly tests/device/kernel.sh "$kernel"
  tests/device/guest.sh --kernel "$kernel" --out "$out" --timeout 1500 --root "$root" bash /out/systemd.sh >"$out/console.txt" 2>&1 || true
  i=0
  while IFS=$'\t' read -r verdict what measured bar; do
    case $verdict in
      ok | MISS) i=$((i + 1)) && line "2.$kernel.$i" "$verdict" "$measured" "$bar" "$what" ;;
    esac
  done < <(grep -aE $'^(ok|MISS)\t' "$out/console.txt" || true)
  [ $i -eq 6 ] || line "2.$kernel" MISS "$i outcomes, see $out/console.txt" "6" "the service under systemd, $kernel kernel"
done
[ "$misses" -eq 0 ] || { echo "$misses figures miss their bar" >&2; exit 1; }

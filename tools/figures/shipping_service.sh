#!/usr/bin/env bash
# The service under systemd: its exposure, and a Debian with the packages booted in a virtual machine (tests/device/guest.sh),
# on the standard kernel and on PREEMPT_RT: ready, real-time, watchdog, crash, stop. One line a figure; a quarter of an hour
# without KVM. --quick: the standard kernel only. Needs root, as figure 1 does, which makes that Debian where it is missing.
# Nothing is drawn at random.
#   tools/figures/shipping_service.sh [--quick]
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/shipping_service.sh [--quick] [2]" "$@"
all_or_named 2
draws
kernels=(standard rt)
[ -z "$quick" ] || kernels=(standard)
[ "$(id -u)" -ne 0 ] || set_up --device
root=$PWD/build/figures/shipping/root

exposure() {
  command -v systemd-analyze >/dev/null ||
    { line 2.exposure SKIP "no systemd-analyze" "at most 2.5, printed" "systemd-analyze security; installed by: apt-get install -y systemd"; return; }
  local score
  score=$(systemd-analyze security --offline=true firmware_app/service/units/hovermodald.service 2>/dev/null | sed -n 's/.*exposure level.*: \([0-9.]*\).*/\1/p' || true)
  judge 2.exposure "${score:-none}" "at most 2.5, printed" "systemd-analyze security --offline=true" "${score:-nan} <= 2.5"
}
booted() { # KERNEL
  local out=build/figures/shipping/guest-$1 i=0 verdict what measured bar
  rm -rf "$out"
  mkdir -p "$out"
  cp tests/device/cases/systemd.sh tests/device/cases/lib.sh "$bin/hold_thread" "$out/"
  quietly tests/device/kernel.sh "$1"
  tests/device/guest.sh --kernel "$1" --out "$out" --timeout 1500 --root "$root" bash /out/systemd.sh >"$out/console.txt" 2>&1 || true
  while IFS=$'\t' read -r verdict what measured bar; do
    case $verdict in
      ok | MISS) i=$((i + 1)) && line "2.$1.$i" "$verdict" "$measured" "$bar" "$what" ;;
    esac
  done < <(grep -aE $'^(ok|MISS)\t' "$out/console.txt" || true)
  [ $i -eq 6 ] || line "2.$1" MISS "$i outcomes of 6, see $out/console.txt" "start, notify, watchdog restart, crash restart with resume, stop" "the service under systemd, $1 kernel"
}
figure_2() {
  local kernel
  exposure
  [ "$(id -u)" -eq 0 ] || { line 2 SKIP "not root" "start, notify, watchdog restart, crash restart with resume, stop" "a Debian of its own to boot; run: sudo tools/figures/shipping_service.sh"; return; }
  if [ ! -x "$root/lib/systemd/systemd" ] || [ ! -x "$root/usr/bin/hovermodald" ]; then
    tools/figures/shipping_packages.sh --quick build install
  fi
  quietly tools/build.sh hold_thread
  for kernel in "${kernels[@]}"; do booted "$kernel"; done
  [[ " ${kernels[*]} " == *" rt "* ]] || line 2.rt SKIP "not with --quick" "the same on Debian's PREEMPT_RT kernel" "run: tools/figures/shipping_service.sh"
}

run_figures 2

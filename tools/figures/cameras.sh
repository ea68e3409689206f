#!/usr/bin/env bash
# The camera drivers on real kernel drivers, in a virtual machine (tests/device). One line a figure; half an hour to an
# hour on two processors without KVM. --quick: fewer frames and restarts, no AddressSanitizer.
#   tools/figures/cameras.sh [--quick] [--first-seed N] [FIGURE...]      FIGURE: some of 1 ... 6 (default: all)
# The clip of figures 2 and 6 is drawn from the first seed.
# Latencies are in virtual time: they compare kernels and settings, and say nothing about any board.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
. tools/figures/device.sh
take_arguments "tools/figures/cameras.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
all_or_named 1 2 3 4 5 6
draws 2 6
set_up --device
export CLIP_SEED=$first_seed
quietly tools/build.sh hovermodal hovermodald usb_camera capture_check camera_contract_device firmware_node
quietly tests/device/kernel.sh standard

few() { [ -z "$quick" ] || echo "$1"; }

figure_1() { outcomes 1 "" FRAMES="$(few 8)" SIZES="$(few '640x480 1920x1080')" -- formats; }
figure_2() { outcomes 2 "" -- usb service; }
figure_3() { outcomes 3 "" TIMES="$(few 10)" -- faults replug; }
figure_4() { outcomes 4 "" TIMES="$(few 10)" -- libcamera contract; }
figure_5() {
  outcomes 5 ", PREEMPT_RT" TIMES="$(few 5)" -- --kernel rt usb faults replug
  local kernel n=0 p50 p99 worst rest
  local -A measured
  for kernel in standard rt; do
    while IFS=$'\t' read -r kind name p50 p99 worst rest; do
      [ "$kind" = figure ] || continue
      n=$((n + 1))
      measured[$kernel ${name##*, }]=$worst
      line "5.$kernel.${name##*, }" beside "p50 $p50, p99 $p99, worst $worst ms" "-" "lateness of the capturing thread, $name scheduling under load, in virtual time; $rest"
    done < <(FRAMES="$(few 300)" LIMIT_S=900 tests/device/run.sh --kernel $kernel --icount latency 2>&1 || true)
  done
  judge 5.latency "worst ${measured[standard realtime]:-nan} ms on the standard kernel, ${measured[rt realtime]:-nan} ms on PREEMPT_RT; ${measured[rt ordinary]:-nan} ms without our settings" \
    "PREEMPT_RT with real-time settings best" "the capturing thread under load, in virtual time; the thread that makes the frames has the same priority in all four runs" \
    "\"${measured[rt realtime]:-}\" != \"\" && ${measured[rt realtime]:-1e9} < ${measured[rt ordinary]:-0} && ${measured[rt realtime]:-1e9} <= ${measured[standard realtime]:-0}"
}
figure_6() {
  [ -z "$quick" ] || { line 6 SKIP "not with --quick" "ASan build through all of 1-4" "run: tools/figures/cameras.sh 6"; return; }
  quietly cmake --preset asan
  quietly cmake --build --preset asan --target hovermodal hovermodald usb_camera capture_check camera_contract_device firmware_node
  # Freed memory is held back for a while, and LeakSanitizer reports leaks: pages are not measured here.
  outcomes 6 ", AddressSanitizer (40 frames at 640x480, 5 times instead of 50)" HOVERMODAL_BIN="$PWD/build/asan/bin" FRAMES=40 TIMES=5 SIZES=640x480 LIMIT_S=1800 CLIP_RATE=3 WATCH_S=440 MOST_KIB=20000 \
    ASAN_OPTIONS=verify_asan_link_order=0:quarantine_size_mb=16 UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1 -- \
    formats usb faults replug libcamera contract service
}

run_figures "${figures[@]}"

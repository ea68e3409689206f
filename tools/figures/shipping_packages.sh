#!/usr/bin/env bash
# The Debian packages: built from a clean clone by one command, installed into a clean Debian, run there; those of arm64
# under emulation. One line a figure. Two hours on two processors, most of it the arm64 build and its emulated tests;
# --quick: a clip of 20 s, and of arm64's unit tests those of core. Needs root (it changes roots), and the network for apt.
#   tools/figures/shipping_packages.sh [--quick] [--first-seed N] [PART...]      PART: build, install, demo, arm64 (default: all)
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
seconds=60 segment=512 unit_tests=(core rt drivers firmware_app)
take_arguments "tools/figures/shipping_packages.sh [--quick] [--first-seed N] [PART...]" "$@"
all_or_named build install demo arm64
draws demo
[ -z "$quick" ] || seconds=20 segment=256 unit_tests=(core)
out=$PWD/build/figures/shipping
clone=$out/clone root=$out/root
commit=$(git rev-parse HEAD) # of all packages, whatever is committed during the run
mkdir -p "$out"
[ "$(id -u)" -eq 0 ] || {
  for part in "${figures[@]}"; do line "1.$part" SKIP "not root" "-" "a clean Debian is a root of its own; run: sudo tools/figures/shipping_packages.sh $part"; done
  finish_figures
  exit 0
}
set_up --package --package-arm64

packages() { ls "$clone/build/package-$1/packages"/*.deb 2>/dev/null; } # ARCHITECTURE

built() { # ARCHITECTURE: packages of the commit, from a clone
  local log=$out/package-$1.log status=0
  if [ ! -d "$clone" ] || [ "$(git -C "$clone" rev-parse HEAD)" != "$commit" ]; then
    rm -rf "$clone"
    git clone -q . "$clone"
    git -C "$clone" reset -q --hard "$commit"
  fi
  # The arm64 packages unpacked for this tree are used by the clone, too.
  if [ -e build/package/arm64-root/.complete ] && [ ! -e "$clone/build/package" ]; then
    mkdir -p "$clone/build/package" && cp -al build/package/arm64-root "$clone/build/package/"
  fi
  "$clone/tools/package.sh" "$1" >"$log" 2>&1 || status=$?
  judge "1.build.$1" "$(packages "$1" | xargs -n 1 basename 2>/dev/null | paste -sd' '), $(grep -o '^lintian: .*' "$log" || tail -n 1 "$log")" \
    "two packages, lintian clean" "tools/package.sh $1 in a clean clone" "$status == 0 && $(packages "$1" | wc -l) == 2"
}

# inside COMMAND...: in the clean Debian, with a /proc of its own
inside() {
  unshare --mount --pid --fork -- bash -c 'mount -t proc proc "$1/proc" && mount -t tmpfs shm "$1/dev/shm" && shift 1 && exec chroot "$@"' \
    inside "$root" "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/var/lib/hovermodal LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"
}

installed() {
  rm -rf "$root"
  quietly mmdebstrap --quiet --variant=apt --components=main bookworm "$root"
  [ -d "$root/dev/shm" ] || mkdir -p "$root/dev/shm"
  cp -L /etc/resolv.conf "$root/etc/resolv.conf"
  mkdir -p "$root/packages"
  cp $(packages amd64) "$root/packages/"
  local status=0 facts
  inside sh -c 'apt-get update -qq && apt-get install -y -qq --no-install-recommends ./packages/*.deb ffmpeg systemd-sysv udev kmod v4l-utils' >"$out/install.log" 2>&1 || status=$?
  facts="$(inside id -nG hovermodal 2>/dev/null | paste -sd' '); $(inside dpkg-query -W -f '${Package} ${Status}; ' hovermodal hovermodal-tools 2>/dev/null)"
  judge 1.install "status $status, groups of the service's user: $facts" "both installed, user in group video" \
    "apt install ./*.deb in a clean Debian 12" "$status == 0 && \"$facts\" ~ /hovermodal video/ && \"$facts\" !~ /unpacked|half/"
  status=0
  inside hovermodald --config /etc/hovermodal/hovermodald.yaml --check >"$out/check.log" 2>&1 || status=$?
  local drawn=0
  inside hovermodald --config /etc/hovermodal/hovermodald.yaml --set camera.driver=synthetic --check >>"$out/check.log" 2>&1 || drawn=$?
  judge 1.configuration "exit $status without a camera, $drawn with the drawn one in its place" "3 (device missing), 0" \
    "the configuration as installed, --check" "$status == 3 && $drawn == 0"
  local wrong
  (. tools/package/completion_check.sh "$root/usr/share/bash-completion/completions/hovermodal" inside) >"$out/completion.log" 2>&1
  wrong=$(grep -c '^missing' "$out/completion.log" || true)
  judge 1.completion "$(grep -c '^ok' "$out/completion.log" || true) commands complete, $wrong words missing" "every word completes" \
    "bash completes every subcommand and option of --help" "$wrong == 0 && $(grep -c '^ok' "$out/completion.log" || true) > 10"
}

demonstrated() {
  local status=0
  inside bash -c "set -e; cd /var/lib/hovermodal && rm -rf demo
    hovermodal simulate --preset paper --duration $seconds --seed $first_seed --out demo
    hovermodald --config demo/config.yaml --set telemetry.lcm_url= --set spectrum.segment=$segment --report demo
    hovermodal identify --series demo/truth_displacements.csv --base base --segment $segment --report demo/true_motion
    hovermodal compare --result demo/modal.json --reference demo/true_motion/modal.json --truth demo/truth.json" >"$out/demo.log" 2>&1 || status=$?
  local demo=$root/var/lib/hovermodal/demo found worst
  read -r found worst < <(tools/figures/modal_difference.py "$demo/true_motion/modal.json" "$demo/modal.json" 2>/dev/null || echo "0 nan")
  judge 1.demo "status $status, $found modes, worst $(awk "BEGIN { printf \"%.2f\", 100 * $worst }") % from those of the true motion" "runs the demo (at least 3 modes, each within 1 %)" \
    "the demo of $seconds s, seed $first_seed, with what is installed, in the clean Debian" "$status == 0 && $found >= 3 && $worst < 0.01"
}

# on_arm64 PROGRAM ARG...: the program under user-mode emulation
on_arm64() { qemu-aarch64 -L "$clone/build/package/arm64-root" "$@"; }

ported() {
  local demo=$root/var/lib/hovermodal/demo arm=$clone/build/package-arm64 here=$out/replay_amd64 there=$out/replay_arm64 status=0
  built arm64
  [ -n "$(packages amd64)" ] || built amd64
  [ -e "$demo/tracks.csv" ] || { line 1.arm64.replay MISS "no tracks" "the demo's" "run the part demo first"; return; }
  # Checks the contents of the packages, not of the build tree.
  rm -rf "$out/amd64" "$out/arm64"
  for architecture in amd64 arm64; do
    for package in $(packages $architecture); do dpkg-deb -x "$package" "$out/$architecture"; done
  done
  "$out/amd64/usr/bin/hovermodal" replay --tracks "$demo/tracks.csv" --config "$demo/config.yaml" --set telemetry.lcm_url= \
    --set spectrum.segment=$segment --report "$here" >"$out/replay.log" 2>&1 || status=$?
  on_arm64 "$out/arm64/usr/bin/hovermodal" replay --tracks "$demo/tracks.csv" --config "$demo/config.yaml" --set telemetry.lcm_url= \
    --set spectrum.segment=$segment --report "$there" >>"$out/replay.log" 2>&1 || status=$?
  local found worst
  read -r found worst < <(tools/figures/modal_difference.py "$here/modal.json" "$there/modal.json" --all 2>/dev/null || echo "0 nan")
  judge 1.arm64.replay "status $status, $found modes, numbers differ by at most $worst of their size" "results equal to amd64 within a stated tolerance (1e-6)" \
    "hovermodal replay of the demo's tracks, arm64 emulated against amd64" "$status == 0 && $found >= 3 && $worst < 1e-6"

  local group log=$out/unit.log targets=() passed failed
  for group in "${unit_tests[@]}"; do targets+=("unit_${group}_tests"); done
  # Emulation is used to discover the tests during the build.
  if ! cmake --build "$arm" ${JOBS:+-j "$JOBS"} --target "${targets[@]}" >"$out/unit_build.log" 2>&1; then
    line 1.arm64.unit MISS "not built, see $out/unit_build.log" "runs the unit tests: all pass" "unit tests, arm64 emulated"
    return
  fi
  : >"$log"
  for group in "${targets[@]}"; do on_arm64 "$arm/tests/$group" >>"$log" 2>&1 || true; done
  passed=$(grep -oE '^\[  PASSED  \] [0-9]+' "$log" | awk '{ n += $4 } END { print n + 0 }')
  failed=$(grep -cE '^\[  FAILED  \] .*\)$' "$log" || true)
  judge 1.arm64.unit "$passed pass, $failed fail, $(grep -c '^\[  PASSED' "$log" || true) of ${#targets[@]} programs came to their end" "runs the unit tests: all pass" \
    "of the unit tests those of ${unit_tests[*]}, arm64 emulated" "$failed == 0 && $passed > 0 && $(grep -c '^\[==========\].*ran' "$log" || true) == ${#targets[@]}"
}

figure_build() { built amd64; }
figure_install() { installed; }
figure_demo() { demonstrated; }
figure_arm64() { ported; }
run_figures "${figures[@]}"

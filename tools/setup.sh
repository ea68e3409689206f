#!/usr/bin/env bash
# Installs what the build, the tests and the demo need on Debian 12, from Debian's packages; nothing when all is there.
#   tools/setup.sh [--runtime] [--device] [--lcm] [--ground] [--package] [--package-arm64] [--mpi] [--fuzz] [--style] [--data]
#     --runtime   also what tools/figures/runtime.sh needs: a model checker, an arm64 compiler and emulator
#     --lcm       also lcm-spy with the message types of hovermodal: a JDK, LCM's Java library, an X server without a screen
#     --device    also what tests/device needs: a machine emulator, a kernel for it, and tools to build a kernel module
#     --ground    also what tools/figures/ground_page.sh needs: a browser and a font
#     --package   also what tools/package.sh needs; --package-arm64: for that architecture, with an emulator to run it
#     --mpi       also what WITH_MPI needs, for `hovermodal batch` across machines: OpenMPI
#     --fuzz      also what tools/fuzz.sh needs: clang 14 with its fuzzer and sanitizers
#     --style     also what the tests of the sources' form need: clang-format and clang-tidy
#     --data      also what tools/data.sh needs to fetch and convert measured data
set -euo pipefail
cd "$(dirname "$0")/.."

packages=(
  build-essential cmake ninja-build ccache pkg-config git python3
  libopencv-dev libeigen3-dev libyaml-cpp-dev libcli11-dev libspdlog-dev libfmt-dev nlohmann-json3-dev
  liblcm-dev liblcm-bin libglib2.0-dev iproute2
  libboost-dev
  ffmpeg
  libsystemd-dev
  libavformat-dev libavcodec-dev libavutil-dev
  libcamera-dev libjpeg-dev libpng-dev
  libmatio-dev zlib1g-dev
  libgtest-dev libgmock-dev librapidcheck-dev
)

fetch_kernel() { [[ " $* " != *" --device "* ]] || tests/device/kernel.sh standard >/dev/null; }
for wanted in "$@"; do
  case $wanted in
    --runtime) packages+=(spin g++-aarch64-linux-gnu qemu-user) ;;
    --lcm) packages+=(default-jdk liblcm-java libjchart2d-java libxmlgraphics-commons-java xvfb python3) ;;
    --device) packages+=(qemu-system-x86 busybox-static cpio kmod udev v4l-utils libcamera-tools libcamera-ipa rt-tests xz-utils bc) ;;
    --ground) packages+=(chromium fonts-dejavu-core python3) ;;
    --package) packages+=(dpkg-dev file gzip lintian man-db python3 binutils) ;;
    --package-arm64) packages+=(g++-aarch64-linux-gnu qemu-user mmdebstrap) ;;
    --mpi) packages+=(libopenmpi-dev openmpi-bin) ;;
    --fuzz) packages+=(clang-14 libclang-rt-14-dev llvm-14) ;;
    --style) packages+=(clang-format clang-tidy) ;;
    --data) packages+=(ca-certificates git python3 python3-numpy python3-scipy ffmpeg) ;;
    *) echo "setup: $wanted: unknown; see the head of tools/setup.sh" >&2; exit 2 ;;
  esac
done

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f '${Status}' "$package" 2>/dev/null || true)
  [ "$status" = "install ok installed" ] || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
  fetch_kernel "$@"
  exit 0
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "setup: run as root or install sudo, to install: ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
echo "setup: installing ${missing[*]}"
log=$(mktemp)
if ! { "${as_root[@]}" apt-get update -qq &&
       "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
  tail -n 30 "$log" >&2
  echo "setup: apt-get could not install them; the whole log is $log" >&2
  exit 1
fi
rm -f "$log"
# What a build looked for and did not find, it looks for again.
for cache in build/*/CMakeCache.txt; do [ ! -e "$cache" ] || touch "$cache"; done
fetch_kernel "$@"

#!/usr/bin/env bash
# Builds the kernel's vimc module (a simulated media pipeline, which libcamera supports) from Debian's kernel source for
# the kernel that kernel.sh has unpacked: Debian does not ship it. Nothing is installed.
#   tests/device/vimc.sh [standard|rt]
set -euo pipefail
cd "$(dirname "$0")/../.."
vm=${HOVERMODAL_VM:-$PWD/build/device}
version=$(tests/device/kernel.sh "${1:-standard}")
module=$vm/kernel/lib/modules/$version/extra/vimc.ko
[ ! -s "$module" ] || exit 0

common=linux-headers-${version%-amd64}-common
[[ $version != *-rt-amd64 ]] || common=linux-headers-${version%-rt-amd64}-common-rt
series=$(echo "$version" | cut -d. -f1,2)
kbuild=$(apt-cache depends "linux-headers-$version" | sed -n 's/.*Depends: \(linux-kbuild-[^ ]*\)/\1/p' | head -n 1)
headers=$vm/headers
mkdir -p "$headers" "$vm/debs"
for package in "linux-headers-$version" "$common" "$kbuild" "linux-source-$series"; do
  ls "$vm/debs/${package}"_*.deb >/dev/null 2>&1 || (cd "$vm/debs" && apt-get download -q "$package" >/dev/null 2>&1)
  dpkg-deb -x "$(ls -t "$vm/debs/${package}"_*.deb | head -n 1)" "$headers"
done
tree=$headers/usr/src/linux-headers-$version
sed -i "s#/usr/src/$common#$headers/usr/src/$common#g" "$tree/Makefile" # they name where they would be installed
source=$vm/vimc-$version
rm -rf "$source" && mkdir -p "$source"
tar -C "$source" -xf "$headers/usr/src/linux-source-$series.tar.xz" --strip-components=5 \
  "linux-source-$series/drivers/media/test-drivers/vimc"
make -s -C "$tree" M="$source" CONFIG_VIDEO_VIMC=m CONFIG_DEBUG_INFO_BTF_MODULES= modules >"$vm/vimc.log" 2>&1 || { tail -n 20 "$vm/vimc.log" >&2 && exit 1; }
mkdir -p "$(dirname "$module")"
cp "$source/vimc.ko" "$module"
depmod -b "$vm/kernel" "$version" 2>/dev/null

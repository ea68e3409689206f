#!/usr/bin/env bash
# Makes a Debian kernel ready for tests/device/guest.sh: unpacks it (nothing is installed) and builds a small initramfs
# whose root becomes this machine's own, read-only through 9p under a memory overlay. Prints the kernel's version.
#   tests/device/kernel.sh [standard|rt]
# Kept in HOVERMODAL_VM (default: build/device of this tree), about 300 MB a kernel; made once.
set -euo pipefail
cd "$(dirname "$0")/../.."
vm=${HOVERMODAL_VM:-$PWD/build/device}
case ${1:-standard} in
  standard) meta=linux-image-amd64 ;;
  rt) meta=linux-image-rt-amd64 ;;
  *) echo "kernel: $1: standard or rt" >&2; exit 2 ;;
esac
package=$(apt-cache depends "$meta" | sed -n 's/.*Depends: \(linux-image-[0-9][^ ]*\)/\1/p' | head -n 1)
[ -n "$package" ] || { echo "kernel: $meta is in no package list: run apt-get update" >&2; exit 1; }
version=${package#linux-image-}
initramfs=$vm/initramfs-$version
if [ -s "$initramfs" ] && [ "$initramfs" -nt tests/device/guest_init.sh ] && [ "$initramfs" -nt tests/device/kernel.sh ]; then
  echo "$version"
  exit 0
fi

mkdir -p "$vm/debs" "$vm/kernel"
if [ ! -s "$vm/kernel/lib/modules/$version/modules.dep" ] || [ ! -d "$vm/kernel/lib/modules/$version/kernel/drivers/block" ]; then
  ls "$vm/debs/${package}"_*.deb >/dev/null 2>&1 || (cd "$vm/debs" && apt-get download -q "$package" >/dev/null 2>&1)
  deb=$(ls -t "$vm/debs/${package}"_*.deb | head -n 1)
  # From Debian 13 on modules lie below /usr/lib, compressed.
  dpkg-deb --fsys-tarfile "$deb" | tar -x -C "$vm/kernel" --transform 's,^\./usr/lib/,./lib/,' --wildcards './boot/vmlinuz-*' '*lib/modules/*/modules.*' \
    '*lib/modules/*/kernel/drivers/media/*' '*lib/modules/*/kernel/drivers/usb/*' '*lib/modules/*/kernel/drivers/virtio/*' \
    '*lib/modules/*/kernel/drivers/char/*' '*lib/modules/*/kernel/drivers/block/virtio_blk.ko*' '*lib/modules/*/kernel/drivers/gpu/drm/*.ko*' \
    '*lib/modules/*/kernel/fs/*' '*lib/modules/*/kernel/net/9p/*' '*lib/modules/*/kernel/lib/*' '*lib/modules/*/kernel/crypto/*' \
    '*lib/modules/*/kernel/sound/core/*'
  depmod -b "$vm/kernel" "$version" 2>/dev/null
fi

tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree"/{bin,modules,proc,sys,dev,lower,rw,new}
cp /bin/busybox "$tree/bin/busybox"
for module in virtio_pci 9pnet_virtio 9p overlay virtio_rng; do
  modprobe -d "$vm/kernel" -S "$version" --show-depends "$module" 2>/dev/null | awk '$1 == "insmod" { print $2 }'
done | awk '!seen[$0]++' | while read -r file; do
  name=$(basename "$file" .xz)
  case $file in
    *.xz) xz -dc "$file" >"$tree/modules/$name" ;;
    *) cp "$file" "$tree/modules/" ;;
  esac
  echo "$name" >>"$tree/modules/order"
done
install -m 755 tests/device/guest_init.sh "$tree/init"
(cd "$tree" && find . | cpio -o -H newc --quiet | gzip -1) >"$initramfs"
echo "$version"

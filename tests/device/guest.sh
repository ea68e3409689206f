#!/usr/bin/env bash
# Runs a command as root in a virtual machine with a Debian kernel of its own and this machine's files, read-only; what it
# writes is gone afterwards, but for /out. Exit status: the command's, or 125 when the machine did not come to its end.
#   tests/device/guest.sh [--kernel standard|rt] [--out DIR] [--timeout S] [--icount] [--root DIR] [--disk DIR] COMMAND [ARG...]
#     --icount   one CPU in virtual time (an instruction takes 8 ns): compares kernels, says nothing about any board
#   --root DIR  a Debian of its own in place of this machine's files, with its systemd as the first process; the command runs
#               in it as a unit, from /, once basic.target is there
#   --disk DIR  DIR/disk.raw is /dev/vda, a disk that may keep writes in its cache; every write and every order to empty that
#               cache is kept in DIR/writes.log, as dm-log-writes of the kernel keeps them
# KVM where it works (HOVERMODAL_KVM=1); else the CPU is emulated, about ten times slower. HOVERMODAL_CPUS: default 2.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
flavour=standard out= limit_s=300 acceleration=tcg,thread=multi cpus=${HOVERMODAL_CPUS:-2} more=() root= disk=
while [ $# -gt 0 ]; do
  case $1 in
    --kernel) flavour=$2 && shift 2 ;;
    --out) out=$2 && shift 2 ;;
    --timeout) limit_s=$2 && shift 2 ;;
    --icount) acceleration=tcg,thread=single cpus=1 more=(-icount shift=3,sleep=off) && shift ;;
    --disk) disk=$(cd "$2" && pwd) && shift 2 ;;
    --root) root=$(cd "$2" && pwd) && shift 2 ;;
    --) shift && break ;;
    -*) echo "guest: $1: unknown option" >&2 && exit 2 ;;
    *) break ;;
  esac
done
[ $# -gt 0 ] || { sed -n '2,10s/^# //p' "$0" >&2 && exit 2; }
command -v qemu-system-x86_64 >/dev/null || { echo "guest: no qemu-system-x86_64: run tools/setup.sh --device" >&2 && exit 125; }
[ "${HOVERMODAL_KVM:-}" != 1 ] || acceleration=kvm

vm=${HOVERMODAL_VM:-$(cd "$here/../.." && pwd)/build/device}
version=$("$here/kernel.sh" "$flavour")
if [ -z "$out" ]; then
  out=$(mktemp -d)
  trap 'rm -rf "$out"' EXIT
fi
mkdir -p "$out"
out=$(cd "$out" && pwd)
rm -f "$out/.status"
printf 'cd %q\n' "$([ -n "$root" ] && echo / || echo "$PWD")" >"$out/.command"
printf '%q ' "$@" >>"$out/.command"
if [ -n "$disk" ]; then
  : >"$disk/writes.log"
  more+=(-blockdev "driver=file,node-name=platter,filename=$disk/disk.raw" -blockdev "driver=file,node-name=log,filename=$disk/writes.log"
    -blockdev driver=blklogwrites,node-name=disk,file=platter,log=log -device virtio-blk-pci,drive=disk,write-cache=on)
fi
# Nehalem: emulating AVX is slower than doing without.
timeout "$limit_s" qemu-system-x86_64 -accel "$acceleration" -cpu "$([ "$acceleration" = kvm ] && echo host || echo Nehalem)" \
  -smp "$cpus" -m 2048 -nodefaults -no-user-config -display none -serial stdio -no-reboot -nic none -device virtio-rng-pci \
  -fsdev local,id=host,path=/,security_model=none,readonly=on,multidevs=remap -device virtio-9p-pci,fsdev=host,mount_tag=host \
  -fsdev local,id=out,path="$out",security_model=none -device virtio-9p-pci,fsdev=out,mount_tag=out \
  -kernel "$vm/kernel/boot/vmlinuz-$version" -initrd "$vm/initramfs-$version" \
  -append "console=ttyS0 panic=-1 quiet loglevel=3 mitigations=off tsc=reliable edd=off kernel_dir=$vm/kernel${root:+ root_dir=$root systemd.unit=guest.service}" "${more[@]}" </dev/null |
  stdbuf -oL tr -d '\r' || true
exit "$(cat "$out/.status" 2>/dev/null || echo 125)"

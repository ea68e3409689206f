#!/bin/busybox sh
# First program of the guest (tests/device/guest.sh): mounts the host's root, runs one script there, switches off.
/bin/busybox --install -s /bin 2>/dev/null
export PATH=/bin
mount -t proc proc /proc
mount -t sysfs sys /sys
mount -t devtmpfs dev /dev
fail() {
  echo "guest: $*"
  poweroff -f
}
while read -r module; do
  insmod "/modules/$module" || echo "guest: insmod $module failed"
done </modules/order
shared=trans=virtio,version=9p2000.L,msize=512000,access=any
mount -t 9p -o "$shared,ro,cache=loose" host /lower || fail "the host's root cannot be mounted"
mount -t tmpfs -o mode=755,size=60% tmpfs /rw
mkdir -p /rw/up /rw/work
mount -t overlay -o lowerdir=/lower,upperdir=/rw/up,workdir=/rw/work overlay /new || fail "no overlay"
for word in $(cat /proc/cmdline); do
  case $word in kernel_dir=*) kernel_dir=${word#*=} ;; esac
done
version=$(uname -r)
mkdir -p "/new/lib/modules/$version" /new/out
mount --bind "/lower$kernel_dir/lib/modules/$version" "/new/lib/modules/$version"
mount -t 9p -o "$shared" out /new/out || fail "the folder for results cannot be mounted"
ip link set lo up
ip route add 224.0.0.0/4 dev lo
for folder in proc sys dev; do
  mount --move "/$folder" "/new/$folder"
done
mkdir -p /new/dev/shm /new/dev/pts
mount -t tmpfs shm /new/dev/shm
mount -t devpts pts /new/dev/pts
for folder in run tmp; do
  mount -t tmpfs "$folder" "/new/$folder"
done
# The first process itself goes there: a root that is not its root is a chroot, where udevadm refuses to work.
cd /new
mount --move . /
exec chroot . /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp TERM=dumb /bin/bash -c \
  '(/bin/bash /out/.command); echo $? >/out/.status; sync; echo o >/proc/sysrq-trigger; sleep 60'

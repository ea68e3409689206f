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
root_dir=
for word in $(cat /proc/cmdline); do
  case $word in kernel_dir=* | root_dir=*) export "$word" ;; esac
done
mount -t overlay -o lowerdir=/lower$root_dir,upperdir=/rw/up,workdir=/rw/work overlay /new || fail "no overlay"
version=$(uname -r)
mkdir -p "/new/lib/modules/$version" /new/out
mount --bind "/lower$kernel_dir/lib/modules/$version" "/new/lib/modules/$version"
mount -t 9p -o "$shared" out /new/out || fail "the folder for results cannot be mounted"
ip link set lo up
ip route add 224.0.0.0/4 dev lo

# A Debian of its own: its systemd is the first process, and guest.service (on the command line of the kernel) the goal.
if [ -n "$root_dir" ]; then
  cat >/new/etc/systemd/system/guest.service <<'UNIT'
[Unit]
Requires=basic.target
After=basic.target
[Service]
Type=oneshot
TimeoutStartSec=infinity
ExecStart=/bin/bash -c '(/bin/bash /out/.command) >/dev/ttyS0 2>&1; echo $? >/out/.status; sync; echo o >/proc/sysrq-trigger; sleep 60'
UNIT
  echo 0123456789abcdef0123456789abcdef >/new/etc/machine-id
  : >/new/etc/fstab
  umount /proc /sys
  cd /new
  mount --move . /
  exec chroot . /lib/systemd/systemd
fi
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

# A clean Debian in a folder, with a clone of the last commit: for figures that follow a user from nothing. Sourced; $root: the folder,
# an absolute path; as root, with mmdebstrap. HOVERMODAL_CCACHE=DIR is used as the compiler's cache in it.
# shellcheck shell=bash
cache=${HOVERMODAL_CCACHE:-}
with=${cache:+, with a compiler cache}

can_make_root() { [ "$(id -u)" -eq 0 ] && command -v mmdebstrap >/dev/null; }

# A SKIP for that line, and false, where no root can be made.
can_show() { # LINE BAR
  can_make_root || { line "$1" SKIP "not root, or no mmdebstrap" "$2" "as root: apt-get install -y mmdebstrap" && return 1; }
}

# Uses this machine's network for apt-get; the programs use only the loopback device.
inside() { chroot "$root" env -i HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 ${cache:+CCACHE_DIR=/ccache} \
  bash -c "cd /hovermodal && export PATH=\$PWD/build/release/bin:\$PATH && $1"; }
leave() { local place; for place in ccache dev/shm dev proc sys; do ! mountpoint -q "$root/$place" || umount "$root/$place" || umount --lazy "$root/$place"; done; }

make_root() { # SUITE
  leave
  # The mounts in it belong to this machine.
  if grep -q " $root/" /proc/mounts; then echo "clean_root: something is still mounted below $root" >&2; exit 1; fi
  rm -rf --one-file-system "$root"
  quietly mmdebstrap --variant=minbase --include=ca-certificates,git "$1" "$root"
  cp /etc/resolv.conf "$root/etc/resolv.conf" 2>/dev/null || true
  cp /etc/apt/apt.conf.d/*proxy* "$root/etc/apt/apt.conf.d/" 2>/dev/null || true
  quietly git clone --no-hardlinks . "$root/hovermodal"
}
enter() {
  [ -d "$root/hovermodal" ] || { echo "clean_root: no $root: begin with its making" >&2; exit 2; }
  leave
  quietly git -C "$root/hovermodal" pull --ff-only "$PWD" HEAD
  mount --bind /proc "$root/proc"
  mount --bind /sys "$root/sys"
  mount --bind /dev "$root/dev"
  mount -t tmpfs tmpfs "$root/dev/shm"
  if [ -n "$cache" ]; then mkdir -p "$root/ccache" && mount --bind "$cache" "$root/ccache"; fi
}

#!/usr/bin/env bash
# Debian 12's packages of arm64 that the build needs, unpacked into build/package/arm64-root for tools/cmake/arm64.cmake:
# beside those of amd64 OpenCV's and LCM's cannot be installed. Nothing of them is run; about a minute and 1.5 GB.
#   tools/package/arm64_root.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
root=$PWD/build/package/arm64-root
[ ! -e "$root/.complete" ] || exit 0
packages=(
  libc6-dev libstdc++-12-dev
  libopencv-dev libeigen3-dev libyaml-cpp-dev libcli11-dev libspdlog-dev libfmt-dev nlohmann-json3-dev
  liblcm-dev libglib2.0-dev libboost-dev libsystemd-dev libavformat-dev libavcodec-dev libavutil-dev libcamera-dev libjpeg-dev libpng-dev libmatio-dev
  libgtest-dev libgmock-dev librapidcheck-dev
)
rm -rf "$root"
mkdir -p "${root%/*}"
mmdebstrap --quiet --variant=extract --architectures=arm64 --components=main --skip=cleanup/apt \
  --include="$(IFS=, && echo "${packages[*]}")" bookworm "$root"

# Links that lead out of the tree, and those that the packages' own scripts would have made.
find "$root/usr" -type l -lname '/*' | while read -r link; do ln -sfr "$root$(readlink "$link")" "$link"; done
libraries=$root/usr/lib/aarch64-linux-gnu
for library in blas/libblas lapack/liblapack; do ln -sf "$library.so.3" "$libraries/$(basename "$library").so.3"; done

# What dpkg-shlibdeps asks of the packages' database: which package a library is of, and the version its symbols came with.
database=$root/var/lib/dpkg
rm -rf "$database"
mkdir -p "$database/info" "$database/updates"
echo arm64 >"$database/arch"
echo 1 >"$database/info/format" # names of packages are qualified
for deb in "$root"/var/cache/apt/archives/*.deb; do
  IFS=_ read -r name _ architecture <<<"$(basename "$deb" .deb)"
  control=$(mktemp -d)
  dpkg-deb --control "$deb" "$control"
  # A package of which several architectures may be installed has its name qualified.
  ! grep -q '^Multi-Arch: same' "$control/control" || name=$name:$architecture
  for file in shlibs symbols; do [ ! -e "$control/$file" ] || cp "$control/$file" "$database/info/$name.$file"; done
  dpkg-deb --fsys-tarfile "$deb" | tar -t | sed 's|^\.||; s|/$||; s|^$|/.|' >"$database/info/$name.list"
  sed '1a Status: install ok installed' "$control/control" >>"$database/status"
  echo >>"$database/status"
  rm -rf "$control"
done
rm -rf "$root"/var/cache/apt/archives "$root"/var/lib/apt
touch "$root/.complete"

#!/usr/bin/env bash
# The Debian packages that an arm64 program needs for its shared libraries, with versions, as one line of a control file:
# from the shlibs files in the tree of arm64_root.sh, as dpkg-shlibdeps does it for programs of this machine.
#   tools/package/arm64_depends.sh PROGRAM
set -euo pipefail
database=$(dirname "$0")/../../build/package/arm64-root/var/lib/dpkg/info
found=()
while read -r library; do
  # libm.so.6 is entry "libm 6"; libfoo-1.2.so would be "libfoo 1.2".
  read -r name version <<<"$(sed -E 's/^(.*)\.so\.(.*)$/\1 \2/; s/^(.*)-([0-9].*)\.so$/\1 \2/' <<<"$library")"
  entry=$(awk -v name="$name" -v version="$version" '$1 == name && $2 == version { $1 = $2 = ""; print; exit }' "$database"/*.shlibs)
  [ -n "$entry" ] || { echo "arm64_depends: $library: of none of the packages in tools/package/arm64_root.sh" >&2; exit 1; }
  found+=("$(xargs <<<"$entry")")
done < <(aarch64-linux-gnu-readelf -d "$1" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p')
[ ${#found[@]} -gt 0 ] || { echo "arm64_depends: $1: no program, or linked to nothing" >&2; exit 1; }
printf '%s\n' "${found[@]}" | sort -u | paste -sd, | sed 's/,\([^ ]\)/, \1/g'

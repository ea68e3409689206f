#!/usr/bin/env bash
# Builds the Debian packages hovermodal and hovermodal-tools, and has lintian look at them.
#   tools/package.sh [amd64|arm64]      default: amd64. They come to lie in build/package-<architecture>/packages
# arm64 is cross-compiled against Debian's packages of that architecture, which are unpacked, not installed.
set -euo pipefail
cd "$(dirname "$0")/.."
architecture=${1:-amd64}
case $architecture in
  amd64) preset=package && tools/setup.sh --package ;;
  arm64) preset=package-arm64 && tools/setup.sh --package --package-arm64 && tools/package/arm64_root.sh ;;
  *) echo "package: $architecture: amd64 or arm64" >&2; exit 2 ;;
esac
build=build/package-$architecture
mkdir -p "$build"
if ! { cmake --preset "$preset" && cmake --build "$build" ${JOBS:+-j "$JOBS"} --target hovermodald hovermodal hovermodal_manuals; } >"$build/package.log" 2>&1; then
  grep -E -A12 'error|Error|FAILED' "$build/package.log" | head -n 80 >&2
  echo "package: the whole log is $build/package.log" >&2
  exit 1
fi
rm -rf "$build/packages"
(umask 022 && cd "$build" && SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct)} cpack -G DEB) >"$build/cpack.log" 2>&1 ||
  { tail -n 20 "$build/cpack.log" >&2; exit 1; }
status=0
findings=$(lintian --allow-root --tag-display-limit 0 --fail-on error,warning "$build"/packages/*.deb) || status=1
ls "$build"/packages/*.deb
if [ $status -eq 0 ]; then echo "lintian: clean${findings:+ (notes below)}"; else echo "lintian: errors or warnings"; fi
[ -z "$findings" ] || echo "$findings"
exit $status

#!/usr/bin/env bash
# The form of changed sources: clang-format and clang-tidy. Prints what differs, by file; exits with 1 when something does.
#   tools/check_style.sh format [FILE...]   without files: the changed ones
#   tools/check_style.sh tidy [FILE...]     needs build/release; without files: at most HOVERMODAL_TIDY_FILES (1) changed ones
# Changed: against the branch that HEAD tracks, or against the commit before HEAD where that is the same; with what is not
# committed. Where the tool or git is missing: a line that says so, and exit status 77.
set -euo pipefail
cd "$(dirname "$0")/.."
what=${1:-} && shift || true
most=${HOVERMODAL_TIDY_FILES:-1}

skip() { echo "SKIP: $*" && exit 77; }
tool() { # prefers the version for which the configuration is written
  command -v "$1-14" || command -v "$1" || skip "no $1 (tools/setup.sh --style)"
}
changed() { # PATTERN
  local base
  git rev-parse -q --verify HEAD >/dev/null 2>&1 || skip "no git history: which sources are changed is not known"
  base=$(git merge-base HEAD '@{upstream}' 2>/dev/null || true)
  [ -n "$base" ] && [ "$base" != "$(git rev-parse HEAD)" ] || base=$(git rev-parse -q --verify HEAD~1 || git rev-parse HEAD)
  { git diff --name-only --diff-filter=d "$base"; git ls-files --others --exclude-standard; } | { grep -E "$1" || true; } | LC_ALL=C sort -u
}

case $what in
  format)
    program=$(tool clang-format)
    files=("$@")
    [ $# -gt 0 ] || mapfile -t files < <(changed '\.(h|cpp)$')
    bad=0
    for file in "${files[@]}"; do
      "$program" --dry-run -Werror "$file" >/dev/null 2>&1 && continue
      echo "$file: clang-format -i $file"
      bad=$((bad + 1))
    done
    echo "${#files[@]} changed sources, $bad not formatted by .clang-format"
    [ "$bad" -eq 0 ]
    ;;
  tidy)
    program=$(tool clang-tidy)
    # Each source by itself: the build compiles several together.
    build=build/tidy
    [ -d build/release ] || skip "no build/release (tools/build.sh)"
    cmake --preset release -B $build -DHOVERMODAL_UNITY=OFF >/dev/null || skip "$build cannot be configured"
    files=("$@") left_out=0
    if [ $# -eq 0 ]; then
      # Only files that the build contains. Few files, because one takes up to a minute.
      mapfile -t files < <(changed '\.cpp$' | while read -r file; do ! grep -qF "/$file\"" $build/compile_commands.json || echo "$file"; done)
      [ ${#files[@]} -le "$most" ] || left_out=$((${#files[@]} - most))
      files=("${files[@]:0:most}")
    fi
    # A header is checked as a changed file itself, not through others. GCC's own options and precompiled headers are unknown
    # to clang.
    commands=$(mktemp -d)
    trap 'rm -rf "$commands"' EXIT
    sed -E 's/ -fpch-preprocess| --param ggc-min-heapsize=[0-9]+| -Winvalid-pch| -Wno-restrict| -fno-predictive-commoning| -include [^ ]*cmake_pch\.hxx//g' \
      $build/compile_commands.json >"$commands/compile_commands.json"
    bad=0
    for file in "${files[@]}"; do
      "$program" --quiet --header-filter='^$' -p "$commands" "$file" 2>/dev/null || bad=$((bad + 1))
    done
    echo "${#files[@]} changed sources, clang-tidy objects to $bad; $left_out left out (HOVERMODAL_TIDY_FILES=N tries more)"
    [ "$bad" -eq 0 ]
    ;;
  *) sed -n '2,7s/^# \{0,1\}//p' "$0" >&2 && exit 2 ;;
esac

#!/usr/bin/env bash
# Opens a report.html in headless Chromium, from the file, as phone (360 x 800) and desk (1280 x 900), light and dark, and
# prints one line "ok|MISS ...": console errors, requests, horizontal overflow, text below 12 px, size. Exit code 1 on a
# MISS, 2 when it cannot be checked.
#   tools/figures/check_report.sh REPORT.html [--screenshots DIR]
#   tools/figures/check_report.sh --self-test      pages with one fault each must be a MISS
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
for program in chromium python3; do
  if ! command -v "$program" >/dev/null; then
    echo "check_report: $program is missing: apt-get install -y $program" >&2
    exit 2
  fi
done
if [ "${1:-}" != --self-test ]; then exec python3 "$here/check_report.py" "$@"; fi

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
misses=0
expect() { # ok|MISS NAME BODY
  printf '<!DOCTYPE html><html><head><meta charset="utf-8"><meta name="viewport" content="width=device-width"></head><body>%s</body></html>' "$3" >"$folder/$2.html"
  got=$(python3 "$here/check_report.py" "$folder/$2.html" || true)
  if [ "${got%% *}" = "$1" ]; then verdict=ok; else verdict=MISS misses=$((misses + 1)); fi
  echo "$verdict self-test $2: $got"
}
expect ok sound '<p>fine</p>'
expect MISS error '<p>x</p><script>undefinedFunction()</script>'
expect MISS console '<p>x</p><script>console.error("bad")</script>'
expect MISS late_error '<p>x</p><script>setTimeout(() => { throw new Error("late") }, 200)</script>'
expect MISS image '<p>x</p><img src="http://127.0.0.1:9/a.png" alt="a">'
expect MISS style '<link rel="stylesheet" href="beside.css"><p>x</p>'
expect MISS fetched '<p>x</p><script>fetch("http://127.0.0.1:9/").catch(() => 0)</script>'
expect MISS wide '<p style="width:500px">x</p>'
expect MISS small '<p style="font-size:9px">x</p>'
[ "$misses" -eq 0 ]

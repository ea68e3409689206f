#!/usr/bin/env bash
# Who may include whom, file by file (ARCHITECTURE.md), and the few rules of form that a compiler does not check.
# Prints one line per violation, "file:line: what", and exits with 1 when there is one.
#
#   tools/check_structure.sh [ROOT]     ROOT: the tree to check, by default the one this script stands in
set -euo pipefail
root=${1:-$(dirname "${BASH_SOURCE[0]}")/..}
cd "$root" || exit 2

rooms=()
for room in core rt drivers firmware_app tools tests; do
  if [ -d "$room" ]; then rooms+=("$room"); fi
done
if [ "${#rooms[@]}" -eq 0 ]; then
  echo "check_structure: no source folder (core, rt, ...) in $PWD" >&2
  exit 2
fi
mapfile -t sources < <(find "${rooms[@]}" -type f \( -name '*.h' -o -name '*.cpp' \) | LC_ALL=C sort)
mapfile -t scripts < <(find "${rooms[@]}" -type f \( -name '*.js' -o -name '*.py' -o -name '*.sh' -o -name '*.java' \) | LC_ALL=C sort)
mapfile -t texts < <(
  find "${rooms[@]}" -type f \( -name '*.h' -o -name '*.cpp' -o -name '*.sh' -o -name '*.py' -o -name '*.cmake' \
    -o -name '*.lcm' -o -name '*.yaml' -o -name '*.service' -o -name 'CMakeLists.txt' \) | LC_ALL=C sort
  find . -maxdepth 1 -type f \( -name '*.md' -o -name '*.json' -o -name 'CMakeLists.txt' \) -printf '%P\n' | LC_ALL=C sort
)
report=$(mktemp)
trap 'rm -f "$report"' EXIT

# The include table. A rule prints the reason for a refusal, or nothing.
check_includes() {
  awk '
    function drivers_rule(file, name) {
      if (name ~ /^core\/types\// || name ~ /^rt\/(spsc_ring|clock|wakeup)\.h$/) return ""
      if (file ~ /^drivers\/storage\/scene\// && name ~ /^core\/simulation\//) return ""
      if (file ~ /^drivers\/storage\// && name ~ /^core\// && name !~ /^core\/simulation\//) return ""
      if (file ~ /^drivers\/telemetry\// && name == "core/rotors/aircraft.h") return ""
      if (file ~ /\/(synthetic_camera|camera_factory|clip_)[^\/]*$/ && name ~ /^core\/simulation\//) return ""
      return "drivers may include of core only types (storage: any plain type; telemetry: the aircraft; scene files, synthetic camera, its factory and clips: simulation), of rt only ring, clock and wakeup"
    }
    function tools_rule(name) {
      if (name ~ /^(core|drivers)\//) return ""
      if (name ~ /^firmware_app\/(service\/pipeline|config\/config|config\/config_table|chain\/observation|chain\/reference_modes|chain\/structure_comparison|chain\/state\/setup_sums|replay\/[a-z_]*|report\/.*)\.h$/) return ""
      return "tools may include core, drivers, and of firmware_app only service/pipeline.h, config/config.h, config/config_table.h, chain/observation.h, chain/reference_modes.h, chain/structure_comparison.h, chain/state/setup_sums.h, replay/ and report/"
    }
    function floor(path) {
      return path ~ /\/config\// ? 1 : path ~ /\/chain\// ? 2 : path ~ /\/report\// ? 3 : path ~ /\/(replay|service)\// ? 4 : 5
    }
    function rule(file, room, name, target) {
      if (target == "tests") return room == "tests" ? "" : "only tests may include tests"
      if (room == "firmware_app" && target == "firmware_app" && floor(name) > floor(file)) return "firmware_app: config < chain < report < replay, service; replay and service do not know each other"
      if (file ~ /^firmware_app\/replay\// && name ~ /^firmware_app\/service\//) return "replay does not know the service"
      if (file ~ /^firmware_app\/chain\// && name ~ /^rt\// && name != "rt/clock.h") return "the chain knows no threads"
      if (room == target) {
        if (file ~ /^core\/simulation\// && name ~ /^core\/closure\//) return "core/simulation must not know core/closure: a test must not be made by what it tests"
        if (file ~ /^core\/(closure|structure)\// && name ~ /^core\/simulation\//) return "core/closure and core/structure must not know core/simulation: a test must not be made by what it tests"
        if (file ~ /^core\/simulation\// && name ~ /^core\/structure\//) return "core/simulation builds structures of its own: a test must not be made by what it tests"
        if (file ~ /^core\/structure\// && name ~ /^core\/closure\//) return "core/structure is a model; core/closure judges it"
        if (file ~ /^core\/types\// && name !~ /^core\/types\//) return "core/types are plain data: they include only each other"
        return ""
      }
      if (room == "tests") return ""
      if (room == "core") return "core includes only core"
      if (room == "rt") return "rt includes only rt"
      if (room == "drivers") return drivers_rule(file, name)
      if (room == "firmware_app") return target == "tools" ? "firmware_app must not know tools" : ""
      if (room == "tools") return tools_rule(name)
      return ""
    }
    # System headers that the rooms must not include.
    function system_rule(room, name) {
      if (room == "core" && name ~ /^(thread|mutex|shared_mutex|condition_variable|atomic|future|chrono|fstream|filesystem|iostream|pthread\.h|time\.h|unistd\.h|sys\/.*|lcm\/.*|spdlog\/.*|yaml-cpp\/.*|opencv2\/(highgui|videoio|imgcodecs).*)$/)
        return "core knows no threads, clocks, files or devices"
      if (room == "rt" && name ~ /^(Eigen|opencv2|lcm|spdlog|yaml-cpp|nlohmann)\//) return "rt needs libc and pthreads only"
      return ""
    }
    /^[ \t]*#[ \t]*include[ \t]*["<]/ {
      split(FILENAME, part, "/"); room = part[1]
      quoted = $0 ~ /include[ \t]*"/
      name = $0; sub(/^[^"<]*["<]/, "", name); sub(/[">].*$/, "", name)
      if (!quoted) why = system_rule(room, name)
      else {
        split(name, part, "/"); target = part[1]
        if (target ~ /^(core|rt|drivers|firmware_app|tools|tests)$/) {
          why = rule(FILENAME, room, name, target)
          if (why == "" && (getline line < name) < 0) why = "no such file"
          close(name)
        } else if (name ~ /^hovermodal\/[a-z_0-9]+_t\.hpp$/) {
          why = FILENAME ~ /^(drivers\/telemetry|tests)\// ? "" : "the generated messages are known to drivers/telemetry only"
        } else why = "includes are written from the root of the tree"
      }
      if (why != "") printf "%s:%d: includes %s: %s\n", FILENAME, FNR, name, why
    }' "${sources[@]}"
}

check_pragma_once() {
  local file
  for file in "${sources[@]}"; do
    if [[ $file == *.h ]] && ! grep -q '^#pragma once$' "$file"; then echo "$file:1: #pragma once is missing"; fi
  done
}

# One namespace a room; within core planning, simulation, structure, closure and monitoring have their own. Braces of *_kernels stand
# within the room's.
check_namespaces() {
  awk '
    function expected(file, part) {
      split(file, part, "/")
      if (part[1] == "core") return part[2] ~ /^(planning|simulation|structure|closure|monitoring)$/ ? "core::" part[2] : "core"
      return part[1] == "firmware_app" ? "app" : part[1]
    }
    FNR == 1 { room = expected(FILENAME) }
    FILENAME ~ /^tests\// || !/^namespace [a-z_:]+ \{/ || $2 ~ /_kernels$/ { next }
    FILENAME ~ /^core\/types\// && $2 ~ /^core(::closure)?$/ { next }  # what the closure reports, as plain data
    FILENAME ~ /^drivers\/camera\/device\// && $2 == "libcamera" { next }  # declares the library'"'"'s own
    $2 != room { printf "%s:%d: namespace %s: the namespace here is %s\n", FILENAME, FNR, $2, room }' "${sources[@]}"
}

check_length() {
  awk 'FNR == 301 { printf "%s:301: over 300 lines: two subjects, split\n", FILENAME }' "${sources[@]}" "${scripts[@]}"
}

# The brackets prevent these patterns from matching this file.
check_texts() {
  grep -nHE '\b(TO[D]O|FIX[M]E|X[X]X)\b' "${texts[@]}" | sed -E 's/^([^:]*:[0-9]+):.*/\1: an open end: do it, or write down what is missing where users read it/' || true
  grep -nHE '(^|[^A-Za-z0-9_.}/])/(hom[e]|wor[k]|roo[t]|tm[p]|Use[r]s|mn[t])/' "${texts[@]}" | sed -E 's/^([^:]*:[0-9]+):.*/\1: an absolute path of one machine/' || true
}

if [ "${#sources[@]}" -gt 0 ]; then
  { check_includes; check_pragma_once; check_namespaces; check_length; } >>"$report"
fi
if [ "${#texts[@]}" -gt 0 ]; then check_texts >>"$report"; fi
cat "$report"
if [ -s "$report" ]; then
  echo "check_structure: $(wc -l <"$report") violations" >&2
  exit 1
fi
echo "check_structure: ${#sources[@]} sources keep the rules"

# Figures 1_debian12 and 1_debian13 of platforms.sh: README's commands on each system, from nothing. Sourced by it.
# shellcheck shell=bash

figure_1_debian12() { system_from_nothing 12 bookworm; }
figure_1_debian13() { system_from_nothing 13 trixie; }

# A clean root, as root; the commands need the network for packages. Then one clip through the service there and here: every file of
# the two reports but the page, which states times, must be the same.
system_from_nothing() { # VERSION SUITE
  local name=1.debian$1 bar="set-up, build, tests, demo's modes equal to the last bit or within the stated cause; minutes of each" step began
  root=$PWD/$out/debian$1
  can_show "$name" "$bar" || return 0
  make_root "$2"
  enter
  local commands=("tools/setup.sh" "tools/build.sh" "tools/test.sh" "tools/demo.sh") words=(set-up build tests demo)
  [ -z "$quick" ] || commands[2]="tools/test.sh --quick"
  for step in 0 1 2 3; do
    began=$SECONDS
    local verdict=ok
    inside "${commands[step]}" >"$out/debian$1_${words[step]}.log" 2>&1 </dev/null || verdict=MISS
    line "$name.${words[step]}" $verdict "$(awk "BEGIN { printf \"%.1f\", ($SECONDS - $began) / 60 }") min: $(grep -v '^$' "$out/debian$1_${words[step]}.log" | tail -n 1 | cut -c1-140)" \
      "$bar" "${commands[step]} in a clean Debian $1 (amd64)$with"
  done
  rm -rf "$out/same_clip" "$root/same_clip"
  quietly "$bin/hovermodal" simulate --preset paper --duration 60 --size 1280x720 --seed "$first_seed" --out "$out/same_clip"
  sed -i 's/^  source: .*/  source: clip.mp4/' "$out/same_clip/config.yaml"
  cp -r "$out/same_clip" "$root/same_clip"
  local service='hovermodald --config config.yaml --set telemetry.lcm_url= --report report' file same=0 all=0 different=''
  quietly bash -c "cd '$out/same_clip' && '$PWD/$bin/'$service"
  quietly inside "cd /same_clip && $service" || true
  for file in "$out/same_clip/report"/*; do
    [ -f "$file" ] && [ "${file##*/}" != report.html ] || continue
    all=$((all + 1))
    if cmp -s "$file" "$root/same_clip/report/${file##*/}"; then same=$((same + 1)); else different+=" ${file##*/}"; fi
  done
  judge "$name.equal" "$same of $all files of the report are the same${different:+; not:$different}" "$bar" \
    "one clip of 60 s through the service on Debian $1 (g++ $(inside 'g++ -dumpversion' 2>/dev/null)) and on this computer (g++ $(g++ -dumpversion)), seed $first_seed" \
    "$same == $all && $all > 8"
  leave
  rm -rf --one-file-system "$root" "$out/same_clip"
}
clean_up() { [ -z "${root:-}" ] || leave; }

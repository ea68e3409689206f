# Figures 2 and 2_debian13 of platforms.sh: cameras on real kernel drivers, in a virtual machine. Sourced by it.
# shellcheck shell=bash disable=SC2154

figure_2() {
  set_up --device
  quietly tools/build.sh capture_check camera_contract_device
  quietly tests/device/kernel.sh standard
  local variables=(FRAMES=20)
  [ -z "$quick" ] || variables+=(SIZES=640x480)
  outcomes 2 ": multi-planar 10 formats x 3 sizes exact" "${variables[@]}" -- multiplanar
}

# cameras.sh as a whole in a clean Debian 13: its kernel and its libcamera are those of the virtual machine.
figure_2_debian13() {
  local bar="camera figures 1-6 on 13's kernel with libcamera 0.4" log=$out/cameras13.log n=0 seen
  root=$PWD/$out/cameras13
  can_show 2.debian13 "$bar" || return 0
  make_root trixie
  enter
  inside "tools/setup.sh && tools/setup.sh --device && tools/figures/cameras.sh ${quick:+--quick}" >"$log" 2>&1 </dev/null || true
  seen="kernel $(inside 'tests/device/kernel.sh standard' 2>/dev/null), libcamera $(inside "dpkg-query -W -f '\${Version}' libcamera-dev" 2>/dev/null)"
  local form='^([0-9][^ ]*) (ok|MISS|SKIP|beside) (.*) \(bar: (.*)\) (.*)$' text
  while read -r text; do
    [[ $text =~ $form ]] || continue
    n=$((n + 1))
    line "2.debian13.${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}" "${BASH_REMATCH[3]}" "${BASH_REMATCH[4]}" "${BASH_REMATCH[5]} (Debian 13)"
  done <"$log"
  judge 2.debian13 "$n lines, $seen" "$bar" "tools/figures/cameras.sh${quick:+ --quick} in a clean Debian 13$with; the first line of its log: $(grep -v '^$' "$log" | head -n 1 | cut -c1-100)" \
    "$n > 20 && \"$seen\" ~ /kernel 6\\./ && \"$seen\" ~ /libcamera 0\\.[4-9]/"
  leave
  rm -rf --one-file-system "$root"
}

# Figures 5_debian12 and 5_debian13 of platforms.sh: packages built, installed, upgraded and removed on each system. Sourced by it.
# shellcheck shell=bash disable=SC2016,SC2154

figure_5_debian12() { packages_of_system 12 bookworm; }
figure_5_debian13() { packages_of_system 13 trixie; }

# The former version: packages of an earlier commit, with a version that sorts before this one's.
former=${HOVERMODAL_FORMER:-HEAD~20}
packages_bar="packages installed and removed on both; upgrade from the former version keeps configuration and state"
package_config=/etc/hovermodal/hovermodald.yaml package_state=/var/lib/hovermodal/state/hovermodal.state

# installed COMMAND: in the clean Debian that has no compiler.
installed() {
  unshare --mount --pid --fork -- bash -c 'mount -t proc proc "$1/proc" && mount -t tmpfs shm "$1/dev/shm" && exec chroot "$1" env -i \
    PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive bash -c "$2"' installed "$place" "$1"
}
packages_in() { find "$root$1/build/package-amd64/packages" -name '*.deb' 2>/dev/null; } # PATH OF A CLONE
set_back() { # FOLDER PACKAGE...: into it, with a version that comes before this one's
  local deb into=$1
  shift
  for deb in "$@"; do
    rm -rf "$out/deb"
    dpkg-deb -R "$deb" "$out/deb"
    sed -i -E 's/^Version: (.*)/Version: \1~former/; s/\(= ([^)]*)\)/(= \1~former)/' "$out/deb/DEBIAN/control"
    quietly dpkg-deb --root-owner-group -b "$out/deb" "$into/$(basename "$deb")"
  done
  rm -rf "$out/deb"
}
# A flight of the drawn scene that is cut off: its state stays. Prints what the service says of a state that it found.
fly_and_fall() {
  installed "cd /var/lib/hovermodal && { timeout -s KILL 20 setpriv --reuid hovermodal --regid hovermodal --clear-groups hovermodald --config $package_config 2>&1 || true; }" 2>/dev/null |
    grep -oE 'goes on with the state|the state in [^ ]* is not taken: [^;]*' | head -n 1 || true
}

packages_of_system() { # VERSION SUITE
  local name=5.debian$1 place=$PWD/$out/installed$1 log=$out/packages$1.log status=0 debs
  root=$PWD/$out/packages$1
  can_show "$name" "$packages_bar" || return 0
  make_root "$2"
  enter
  : >"$log"
  local before
  before=$(git rev-parse --short "$former")
  inside "tools/package.sh" >>"$log" 2>&1 </dev/null || status=$?
  judge "$name.build" "$(packages_in /hovermodal | xargs -r -n 1 basename | paste -sd' '), $(grep -o '^lintian: .*' "$log" || tail -n 1 "$log")" "$packages_bar" \
    "tools/package.sh in a clean Debian $1 (amd64), lintian clean$with" "$status == 0 && $(packages_in /hovermodal | wc -l) == 2"
  quietly git clone --no-hardlinks . "$root/former"
  quietly git -C "$root/former" checkout "$before"
  inside "cd /former && tools/package.sh" >>"$log" 2>&1 </dev/null || true # its lintian is not judged

  clean_system "$2"
  mapfile -t debs < <(packages_in /former)
  set_back "$place/former" "${debs[@]}"
  packages_in /hovermodal | xargs -r -I{} cp {} "$place/present/"
  leave
  rm -rf --one-file-system "$root"
  use_packages "$name" "$before" "$1"
  rm -rf --one-file-system "$place"
}

clean_system() { # SUITE
  rm -rf --one-file-system "$place"
  quietly mmdebstrap --variant=apt --components=main "$1" "$place"
  cp -L /etc/resolv.conf "$place/etc/resolv.conf"
  cp /etc/apt/apt.conf.d/*proxy* "$place/etc/apt/apt.conf.d/" 2>/dev/null || true
  mkdir -p "$place/dev/shm" "$place/former" "$place/present"
}

# Installs, upgrades, removes and purges what lies in $place/former and $place/present.
use_packages() { # NAME FORMER-COMMIT VERSION
  local name=$1 before=$2 status=0
  installed "apt-get update -qq && apt-get install -y -qq --no-install-recommends /former/*.deb systemd" >>"$log" 2>&1 || status=$?
  judge "$name.installed" "$(versions)" "$packages_bar" "apt-get install of the former packages ($before) in a clean Debian $3" \
    "$status == 0 && \"$(versions)\" ~ /hovermodal [^ ]*former.*hovermodal-tools [^ ]*former/"

  # The user's own lines; no camera, no privileges of real time and no radio are here.
  sed -i -E 's/^  driver: v4l2.*/  driver: synthetic\n  pace: realtime\n  synthetic: {duration_s: 600}/; s/^  directory: state.*/&\n  period_s: 2/; s/^  priority: .*/  priority: 0/; s/^  lock_memory: .*/  lock_memory: false/; s/^  lcm_url: .*/  lcm_url: ""/' "$place$package_config"
  local own first second third
  own=$(sha256sum <"$place$package_config")
  first=$(fly_and_fall)
  second=$(fly_and_fall)
  status=0
  installed "apt-get install -y -qq --no-install-recommends /present/*.deb" >>"$log" 2>&1 || status=$?
  third=$(fly_and_fall)
  judge "$name.upgraded" "$(versions); the configuration is $([ "$(sha256sum <"$place$package_config")" = "$own" ] && echo "as the user left it" || echo changed); a second flight before: \"$second\", the first after: \"$third\"; unit and rules: $(present usr/lib/systemd/system/hovermodald.service usr/lib/udev/rules.d/60-hovermodal.rules)" \
    "$packages_bar" "apt-get install of this version over the former" \
    "$status == 0 && \"$(versions)\" !~ /former/ && \"$(sha256sum <"$place$package_config")\" == \"$own\" && \"$first\" == \"\" && \"$second\" ~ /goes on/ && \"$third\" ~ /goes on/ && \"$(present usr/lib/systemd/system/hovermodald.service usr/lib/udev/rules.d/60-hovermodal.rules)\" == \"all\""

  status=0
  installed "apt-get remove -y -qq hovermodal hovermodal-tools" >>"$log" 2>&1 || status=$?
  judge "$name.removed" "programs: $(present usr/bin/hovermodald usr/bin/hovermodal); configuration and state: $(present "${package_config#/}" "${package_state#/}")" "$packages_bar" \
    "apt-get remove: programs go, configuration and state stay" "$status == 0 && \"$(present usr/bin/hovermodald usr/bin/hovermodal)\" == \"none\" && \"$(present "${package_config#/}" "${package_state#/}")\" == \"all\""
  mkdir -p "$place/var/lib/hovermodal/report" && touch "$place/var/lib/hovermodal/report/modal.json"
  installed "apt-get purge -y -qq hovermodal hovermodal-tools" >>"$log" 2>&1 || status=$?
  judge "$name.purged" "configuration and state: $(present "${package_config#/}" "${package_state#/}"); a report: $(present var/lib/hovermodal/report/modal.json)" "$packages_bar" \
    "apt-get purge: both go, reports stay" "$status == 0 && \"$(present "${package_config#/}" "${package_state#/}")\" == \"none\" && \"$(present var/lib/hovermodal/report/modal.json)\" == \"all\""
}
versions() { installed "dpkg-query -W -f '\${Package} \${Version} \${Status}; ' hovermodal hovermodal-tools" 2>/dev/null || echo "not installed"; }
present() { # PATH...: of these, in the clean Debian: none, some or all
  local path n=0
  for path in "$@"; do [ ! -e "$place/$path" ] || n=$((n + 1)); done
  if [ $n = 0 ]; then echo none; elif [ $n = $# ]; then echo all; else echo "$n of $#"; fi
}

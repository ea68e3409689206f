#!/usr/bin/env bash
# LCM's own lcm-spy with the message types of hovermodal: every channel, its rate, and the fields of every message.
#   tools/lcm_spy.sh [URL]     URL: by default udpm://239.255.76.67:7667?ttl=0, as the service's
# Starts its main class directly: the script /usr/bin/lcm-spy of Debian 12 asks Java for a collector that is gone.
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in -h | --help) sed -n '2,4s/^# \{0,1\}//p' "$0"; exit 0 ;; esac
url=${1:-udpm://239.255.76.67:7667?ttl=0}
types=build/release/hovermodal_lcm.jar

fail() { echo "lcm_spy: $1" >&2; exit 1; }
command -v java >/dev/null || fail "no java: tools/setup.sh --lcm installs it (Debian: default-jdk)"
path=$types
for library in lcm jchart2d xmlgraphics-commons; do
  [ -e "/usr/share/java/$library.jar" ] || fail "no /usr/share/java/$library.jar: tools/setup.sh --lcm installs it (Debian: liblcm-java libjchart2d-java)"
  path+=":/usr/share/java/$library.jar"
done
[ -e "$types" ] || fail "no $types: with a JDK (tools/setup.sh --lcm) configure and build again: cmake --preset release && cmake --build build/release --target hovermodal_lcm_jar"
[ -n "${DISPLAY:-}" ] || fail "no screen (DISPLAY is empty): start it on a desktop, over ssh -X, or under xvfb-run"
exec java -Djava.net.preferIPv4Stack=true -cp "$path" lcm.spy.Spy --lcm-url="$url"

# Figure 4 of endurance.sh: power cuts. Sourced by it.
# shellcheck shell=bash

# The service runs in a virtual machine; the power is cut afterwards, in what reached its disk (tests/device/power_cuts.py).
figure_4() {
  local cuts=100 status=0 table=$work/power_cuts.txt what
  [ -z "$quick" ] || cuts=10
  if ! quietly tools/setup.sh --device; then
    line 4 SKIP "no virtual machine" "nothing unreadable" "tools/setup.sh --device, as root, brings it"
    return
  fi
  quietly tools/build.sh hovermodal hovermodald
  tests/device/power_cuts.py "$bin" "$work/power" $cuts "$first_seed" >"$table" 2>"$work/power.err" || status=$?
  if [ $status -gt 1 ] || ! grep -q '^faulty' "$table"; then
    line 4 MISS "it ended early: $(grep . "$work/power.err" | tail -n 1)" "nothing unreadable" "power cuts in the guest"
    return
  fi
  value() { awk -F'\t' -v name="$1" '$1 == name { print $2 }' "$table"; }
  awk -F'\t' '$1 == "cut" && $NF != "whole" { print "# " $0 }' "$table"
  what="$cuts power cuts at random writes to the guest's disk, $(seeds_of $cuts): file system, report, state and record as at the next start"
  judge 4 "$(value faulty) of $cuts cuts leave something unreadable or take what a run had ended with; $(value resumed) starts go on with a state" \
    "100 power cuts in the guest: nothing unreadable" "$what" "$(value faulty) == 0 && $(value resumed) > 0"
  line 4.record beside "median $(value record_lost_s) s, at most $(value record_lost_most_s) s" - "the end of the record that a cut takes; resolution 1.5 s"
}

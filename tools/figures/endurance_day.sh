# Figure 6 of endurance.sh: ten hours of stream. Sourced by it.
# shellcheck shell=bash

# Two runs of the whole service with everything on, in a network of their own (tools/figures/endurance_day.py).
figure_6() {
  quietly tools/build.sh hovermodal hovermodald
  local hours=10 table=$work/day.txt program what name least most
  [ -z "$quick" ] || hours=0.7
  cat >"$work/day_run.sh" <<'R'
ip link set lo up && ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo
exec tools/figures/endurance_day.py "$@"
R
  if ! unshare -rn bash "$work/day_run.sh" "$bin" "$work/day" $hours "$first_seed" >"$table" 2>"$work/day.err" || ! grep -q '^different' "$table"; then
    line 6 MISS "it ended early: $(grep . "$work/day.err" | tail -n 1)" "memory slope 0 within 1 kB/min after the first 10 minutes" "$hours hours of stream"
    return
  fi
  told() { awk -F'\t' -v name="$1" '$1 == name { print $2 }' "$table"; }
  what="$(told hours) hours of stream as fast as it goes, seed $first_seed: record, state, loop, page and spy on"
  grep -E '_mean_slope|^words|^samples|^for_a_moment' "$table" | sed 's/^/# /'
  for program in service ground spy; do
    name=$program
    [ "$program" != ground ] || name="the page's program"
    judge "6.memory.$program" "$(told ${program}_slope) kB/min; least of the first ten minutes $(told ${program}_first) kB, of the last $(told ${program}_last) kB, most $(told ${program}_most) kB" \
      "memory slope 0 within 1 kB/min after the first 10 minutes" "$what; $name; least of every ten minutes of stream" \
      "$(told ${program}_slope) <= 1 && $(told ${program}_slope) >= -1"
    read -r least most <<<"$(told ${program}_fd)"
    judge "6.descriptors.$program" "least and most: $least $most" "descriptors constant" "$what; $name" "$least == $most && $least > 0"
    read -r least most <<<"$(told ${program}_held)"
    line "6.held.$program" beside "least and most: $least $most" none "$what; $name; the fewest descriptors of every ten minutes: what is not given back"
  done
  judge 6.bytes "$(told different | cut -d' ' -f1) of $(told files) files differ$(told different | cut -s -d' ' -f2- | sed 's/^\(.\)/: \1/')" \
    "bytes of the result equal to a second run" "every file of the report, the page without its section on this run's times; exit codes $(told code)" \
    "$(told different | cut -d' ' -f1) == 0 && $(told files) > 8 && $(told browser) == 1"
  rm -rf "$work/day"
}

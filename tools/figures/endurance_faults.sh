# Figures 2 and 3 of endurance.sh: calls that fail, and kills. Sourced by it.
# shellcheck shell=bash

# Every n-th call of a run fails, n = 1, 2, ...; tests/faults/fault_runs.py says what a crash and a silent loss are.
figure_2() {
  quietly tools/build.sh hovermodal hovermodald fault_calls
  local every=1 program
  [ -z "$quick" ] || every=25
  local runs=("$bin" "$bin/libfault_calls.so" "$work/faults" --every $every --jobs 2 --seed "$first_seed")
  python3 -B tests/faults/fault_runs.py "${runs[@]}" >"$work/faults.txt" || true
  [ ! -s "$work/faults/findings.txt" ] || cut -c1-250 "$work/faults/findings.txt" >"$work/findings.txt"
  for program in service replay; do faults_line "2.$program" "$program" "$work/faults.txt"; done
  # Where operator new finds the reserve of the process taken, destructors of other libraries that allocate end it.
  python3 -B tests/faults/fault_runs.py "${runs[@]}" --kinds enomem_thrown >"$work/thrown.txt" || true
  for program in service replay; do faults_line "2.$program.thrown" "$program" "$work/thrown.txt" beside; done
}
faults_line() { # NUMBER PROGRAM TABLE [beside]
  local counts kinds n_runs reached crashes silent told what
  counts=$(awk -F'\t' -v p="$2" '$1 == p { k++; for (i = 3; i <= 7; i++) n[i] += $i } END { print k + 0, n[3] + 0, n[4] + 0, n[5] + 0, n[6] + 0, n[7] + 0 }' "$3")
  read -r kinds n_runs reached crashes silent told <<<"$counts"
  what="one call in each run of $([ "$2" = service ] && echo hovermodald || echo "hovermodal replay") fails: $(awk -F'\t' -v p="$2" '$1 == p { printf "%s%s %s", (n++ ? ", " : ""), $2, $3 }' "$3")"
  local measured="$n_runs runs of $kinds kinds, $reached reached their call, $told said so; $crashes crashes, $silent silent losses"
  if [ -n "${4:-}" ]; then
    line "$1" beside "$measured" none "$what; memory runs out after its reserve"
  else
    judge "$1" "$measured" "all n of ten kinds (some thousand runs): 0 crashes, 0 silent losses" "$what$([ -z "$quick" ] || echo "; every 25th n")" \
      "$kinds == 10 && $n_runs > 100 && $crashes == 0 && $silent == 0"
  fi
}

# Kills of the service with report, record and state on, by the script that runtime.sh 5 uses.
figure_3() {
  quietly tools/build.sh hovermodal hovermodald kill_account
  local kills=200
  [ -z "$quick" ] || kills=20
  { tools/figures/runtime_kill.py "$bin" "$work/kills" $kills "$first_seed" --report >"$work/kill_runs.txt" &&
    "$bin/kill_account" "$work/kills" >"$work/kill_account.txt"; } 2>"$work/kills.err" ||
    { line 3 MISS "it ended early: $(grep . "$work/kills.err" | tail -n 1)" "old report readable 200 of 200" "kills"; return; }
  local table=$work/kill_runs.txt account=$work/kill_account.txt
  k() { awk -F'\t' -v name="$2" '$1 == name { v = $2 } END { print v == "" ? "nan" : v }' "$1"; }
  local what="$kills kills (SIGKILL) at random instants of hovermodald with report, record and state on, seeds $first_seed-$((first_seed + kills - 1))"
  judge 3.report "$(k "$table" reports_kept) of $kills" "old report readable 200 of 200" "$what; every byte of every file" \
    "$(k "$table" reports_kept) == $kills"
  judge 3.resumed "$(k "$table" starts_resumed) of $kills" "resumed 200" "$what; the start after each" "$(k "$table" starts_resumed) == $kills"
  judge 3.sums "$(k "$account" equal) of $(k "$account" states) states equal (first other: $(k "$account" first_wrong)), $(k "$account" unreadable) unreadable; $(k "$account" other_frames) of $(k "$account" frames) recorded frames differ from a whole run's" \
    "sums equal to those of an uninterrupted run with the same cells masked" "$what" \
    "$(k "$account" states) > 0 && $(k "$account" equal) == $(k "$account" states) && $(k "$account" unreadable) == 0 && $(k "$account" frames) > 0 && $(k "$account" other_frames) == 0"
}

# Figures 4 to 6 of the main job: LCM, the same run twice, every frame accounted for. Sourced by main_job.sh.
small=$out/small
small_clip() { # drawn once for each seed
  [ "$(cat "$small/seed.txt" 2>/dev/null)" != "$first_seed" ] || return 0
  quietly "$bin/hovermodal" simulate --preset paper --size 480x270 --duration 40 --seed "$first_seed" --force --out "$small"
  echo "$first_seed" >"$small/seed.txt"
}

# --- 4: LCM, in a network of its own (loopback and a multicast route, nothing else) --------------------------------------
in_private_network() { unshare -rn sh -c 'ip link set lo up && ip route add 224.0.0.0/4 dev lo && exec "$@"' sh "$@"; }
figure_4() {
  local part result verdict what
  if ! unshare -rn true 2>/dev/null; then
    line 4 SKIP "no private network (unshare -rn refused)" "counts equal" "LCM to a second process"
    return
  fi
  small_clip
  rm -f "$out/lcm/live.txt" "$out/lcm/log.txt"
  in_private_network tools/figures/lcm_run.sh "$small" "$out/lcm" || true
  for part in live log; do
    result=$(cat "$out/lcm/$part.txt" 2>/dev/null || echo "no result")
    case $result in ok*) verdict=ok ;; *) verdict=MISS ;; esac
    what="a second process hears a run over udpm on loopback"
    [ $part = live ] || what="its LCM log replayed by lcm-logplayer"
    line "4$([ $part = live ] && echo a || echo b)" $verdict "${result#* }" "counts equal, sequence unbroken" "$what"
  done
}

# --- 5: the same replay twice ---------------------------------------------------------------------------------------------
replay_twice() {  # CONFIG
  local k file
  for k in 1 2; do quietly "$bin/hovermodald" --config "$1" --set telemetry.lcm_url= --report "$out/twice_$k"; done
  for file in modal.json tracks.csv displacements.csv; do
    cmp -s "$out/twice_1/$file" "$out/twice_2/$file" || same=no
    compared=$((compared + 1))
  done
}
figure_5() {
  local same=yes compared=0
  small_clip
  replay_twice "$small/config.yaml"
  if [ -d "$data/tuning_forks" ]; then
    fork_config fork_64hz_250fps 250 "[276, 64, 50, 80]" "[340, 64, 50, 80]"
    replay_twice "$out/fork_64hz_250fps.yaml"
  fi
  judge 5 "$compared files compared, identical: $same" "byte-identical" "the same clip twice, seed $first_seed" \
    "\"$same\" == \"yes\" && $compared > 0"
}

# --- 6: every frame accounted for ------------------------------------------------------------------------------------------
figure_6() {
  local runs=0 wrong=0 report log tests="not run" ran=0
  small_clip
  quietly "$bin/hovermodald" --config "$small/config.yaml" --set telemetry.lcm_url= --report "$out/accounted"
  while read -r report; do
    runs=$((runs + 1))
    awk '/"frames_in"|"frames_processed"|"frames_dropped"/ { key = $1; gsub(/[^0-9]/, "", $2); v[key] = $2 } END { exit v["\"frames_in\":"] != v["\"frames_processed\":"] + v["\"frames_dropped\":"] || v["\"frames_in\":"] == 0 }' "$report" || wrong=$((wrong + 1))
  done < <(find "$out" -name modal.json -newer "$bin/hovermodald" | grep -v true_motion)
  quietly tools/build.sh integration_tests fault_calls clock_steps
  if log=$(ctest --test-dir build/release -L integration 2>&1); then tests=pass; else tests=fail; fi
  ran=$(echo "$log" | awk '/tests passed/ { print $NF }')
  judge 6 "$((runs - wrong)) of $runs runs here; integration tests (which assert it): $tests, $ran" \
    "frames in = processed + dropped, all" "every frame accounted for" "$runs > 0 && $wrong == 0 && \"$tests\" == \"pass\""
}

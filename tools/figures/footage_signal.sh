# Figures 2 and 4 of real footage: covered regions, glitches, short records. Sourced by footage.sh, with $out, $first_seed, $quick.
footage_check() { # NAME SEEDS: the table of a self-test, in $out/NAME.txt
  "$bin/hovermodal-validate" "$1" --first-seed "$first_seed" --seeds "$2" --threads "$(nproc)" >"$out/$1.txt" ||
    echo "# validate $1 failed" # its lines are then MISS
}

figure_2() {
  local n=10 what rows
  [ -z "$quick" ] || n=2
  footage_check footage-covered "$n"
  footage_check footage-glitches "$n"
  for what in covered glitch; do
    rows=$(awk -F'\t' -v what="$what" '$1 == what' "$out"/footage-covered.txt "$out"/footage-glitches.txt)
    read -r records modes kept false_modes mac hz named masked < <(awk -F'\t' 'BEGIN { m = 1 }
      { r += $3; w += $4; k += $5; f += $6; if ($7 < m) m = $7; if ($8 > h) h = $8; n += $9; o += $10 }
      END { if (!NR) { print "nan nan nan nan nan nan nan nan"; exit } print r, w, k, f, m, h, n, o }' <<<"$rows")
    judge "2-$what" "$records records: false structural modes $false_modes, modes kept $kept of $modes, least MAC of the rest $mac; frequencies within $hz %; channel named and left out in $named, masked in $masked" \
      "no false structural mode in any, all other channels' modes kept, MAC of the rest >= .99" \
      "$([ "$what" = covered ] && echo "each of six floors covered from frame 10, from 20 %, from 60 % on" || echo "one-frame glitches of 5, 20, 100 px in each of six floors"), $(seeds_of "$n")" \
      "$records == $((n * 18)) && $false_modes == 0 && $kept == $modes && $mac >= 0.99"
  done
}

figure_4() {
  local n=200 way
  [ -z "$quick" ] || n=20
  footage_check footage-short "$n"
  for way in service series; do
    read -r rows worst where structural candidates < <(awk -F'\t' -v way="$way" '$1 == "short" && $3 == way {
      rows++; share = 100 * $7 / $4; if (share >= w) { w = share; where = $2 } s += $5; c += $8 }
      END { if (!rows) { print "0 nan nan nan nan"; exit } gsub(" ", "_", where); print rows, w, where, s, c }' "$out/footage-short.txt")
    judge "4-$way" "records with a false structural mode at most $worst % (${where//_/ }); $structural structural modes, $candidates candidates in all" \
      "false structural in at most 1 %" \
      "records of 0.5, 1, 2, 5, 10, 20 cycles of the lowest mode, and noise of 28 to 1500 samples, $(seeds_of "$n"); $([ "$way" = service ] && echo "tracks through the service's chain" || echo "the same displacements as a time series")" \
      "$rows == 12 && $worst <= 1"
  done
}

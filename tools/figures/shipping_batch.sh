#!/usr/bin/env bash
# A folder of flights by one process, by two, and by two ranks of MPI: one result, and what it gains. One line a figure;
# two minutes beside the builds, --quick: one.
#   tools/figures/shipping_batch.sh [--quick] [--first-seed N] [FIGURE...]      FIGURE: 4
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/shipping_batch.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
all_or_named 4
flights=8 duration_s=180
[ -z "$quick" ] || flights=6 duration_s=120
out=$PWD/build/figures/batch
mkdir -p "$out"
set_up --mpi
quietly tools/build.sh hovermodal
[ -f build/mpi/build.ninja ] || quietly cmake --preset mpi
quietly cmake --build build/mpi --target hovermodal

folder=$out/flights_of_${duration_s}s_from_$first_seed
# One seed per flight, two views alternately: sums are added within each view, their modes combined across views.
make_flights() {
  local seed size
  for seed in $(seq "$first_seed" $((first_seed + flights - 1))); do
    size=1080p
    [ $((seed % 2)) = 1 ] || size=720p
    quietly "$bin/hovermodal" simulate --preset paper --tracks-only --points 15 --duration "$duration_s" --size "$size" \
      --seed "$seed" --out "$folder/$(printf '%04d' "$seed")"
  done
}

# timed NAME COMMAND...: runs it, its seconds in $out/NAME.s
timed() {
  local name=$1 begin
  shift
  begin=$(date +%s.%N)
  quietly "$@" --out "$out/$name"
  awk -v a="$begin" -v b="$(date +%s.%N)" 'BEGIN { print b - a }' >"$out/$name.s"
}

gain() { # NAME: speed relative to one process
  awk -v one="$(cat "$out/one.s")" -v this="$(cat "$out/$1.s")" 'BEGIN { printf "%.2f", one / this }'
}

figure_4() {
  local name different value sigma best worst n
  make_flights
  rm -rf "$out"/{one,two,mpi}
  timed one "$bin/hovermodal" batch "$folder" --jobs 1
  timed two "$bin/hovermodal" batch "$folder" --jobs 2
  timed mpi mpirun --allow-run-as-root --oversubscribe --mca btl self,vader -n 2 \
    build/mpi/bin/hovermodal batch "$folder" --mpi
  for name in two mpi; do
    read -r n different < <(python3 tools/figures/batch_account.py same "$out/one/batch.json" "$out/$name/batch.json")
    judge 4 "largest relative difference of $n numbers $different; $(gain "$name") times as fast as one ($(nproc) processors)" \
      "the result equals the single-machine one to 1e-12, speed-up printed" "$flights flights, one process against $([ $name = two ] && echo 'two' || echo 'two ranks of MPI')" "$n > 0 && $different <= 1e-12"
  done
  read -r n best sigma worst value < <(python3 tools/figures/batch_account.py truth "$out/one/batch.json" "$folder/$(printf '%04d' "$first_seed")/truth.json")
  judge 4 "at most $best of the best single flight's, $sigma of the median flight's; $n modes" "less than the best single flight's sigma" \
    "stated standard deviation of all flights, f and damping" "$n >= 3 && $best < 1"
  judge 4 "$worst sigma at most, rms $value" "3" "f and damping of all flights against the simulated truth" "$worst <= 3"
}
run_figures "${figures[@]}"

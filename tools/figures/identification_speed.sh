#!/usr/bin/env bash
# The figures of Welch's estimate and of the identification's cost. One line a figure.
#   tools/figures/identification_speed.sh [--quick]      --quick takes 2 rounds of the clock instead of 8, 10^6 samples
# Needs, beside tools/setup.sh, Debian's python3-scipy and valgrind (or perf with hardware counters). The comparator runs
# with the reference BLAS and with OpenBLAS, each chosen by LD_LIBRARY_PATH; a missing OpenBLAS is unpacked into the
# build folder, not installed.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
rounds=8 samples=10000000
[ "${1:-}" != --quick ] || { rounds=2 samples=1000000; }
out=build/figures/identification_speed
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh golden_tests accumulator_memory identification_speed
python=/usr/bin/python3
libraries=/usr/lib/$(gcc -print-multiarch)
speed=$bin/identification_speed

# --- 1: Welch against scipy.signal.csd --------------------------------------------------------------------------------
worst=none
if build/release/tests/golden_tests --gtest_filter='WelchGolden.*' --gtest_output="json:$out/golden.json" >"$out/golden.txt" 2>&1; then
  worst=$(awk -F'"' '/"worst_relative_deviation"/ { print $4 }' "$out/golden.json")
fi
judge 1a "worst relative deviation $worst" "<= 1e-10" \
  "Welch against the golden file: three windows, overlaps 0 ... 0.75, odd lengths, two channels" \
  "\"$worst\" != \"none\" && ${worst/none/1} <= 1e-10"
if "$python" -c 'import scipy.signal' 2>/dev/null; then
  verdict=MISS
  ! text=$("$python" tests/golden/make_welch_golden.py --check) || verdict=ok
  line 1b $verdict "$text" "<= 1e-10" "the golden file against the installed scipy"
else
  line 1b SKIP "no python3-scipy" "<= 1e-10" "the golden file against the installed scipy"
fi

# --- 9: the accumulator -----------------------------------------------------------------------------------------------
verdict=MISS
! "$bin/accumulator_memory" "$samples" >"$out/memory.txt" || verdict=ok
line 9 $verdict "$(tr '\t\n' ' ;' <"$out/memory.txt")" "no allocation, no byte more" "12 channels, segments of 1024, hops of 512"

# --- 10: one update ---------------------------------------------------------------------------------------------------
openblas=$libraries/openblas-pthread
if [ ! -e "$openblas/libblas.so.3" ]; then
  unpacked=$PWD/$out/openblas
  [ -e "$unpacked" ] || (mkdir -p "$unpacked.new" && cd "$unpacked.new" && apt-get download -qq libopenblas0-pthread 2>/dev/null &&
    dpkg -x libopenblas0-pthread*.deb . && mv "$unpacked.new" "$unpacked") || true
  openblas=$unpacked$libraries/openblas-pthread
fi
[ -e "$openblas/libblas.so.3" ] || openblas=

"$speed" make "$out/motion.bin"
ours() { # METHOD BLOCK_ROWS
  "$speed" run "$out/motion.bin" "$1" "$2" 5 "$out/poles_ours_$1.txt"
}
theirs() { # LIBRARIES NAME METHOD BLOCK_ROWS FACTORISER
  OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 LD_LIBRARY_PATH=$1 "$python" tests/bench/identification_speed.py \
    "$out/motion.bin" "$3" "$4" 3 "$out/poles_$2_$3.txt" "$5"
}
least() { # FILE: milliseconds
  awk '{ if (m == "" || $1 + 0 < m) m = $1 + 0 } END { printf "%.2f", m }' "$1"
}

compare_update() { # METHOD BLOCK_ROWS REFERENCE_BAR OPENBLAS_BAR
  local name=$out/ms_$1 r
  rm -f "$name"_*.txt
  for ((r = 0; r < rounds; ++r)); do # taken in turn, so that what else the machine does falls on all
    ours "$1" "$2" >>"${name}_ours.txt"
    theirs "$libraries/blas:$libraries/lapack" reference "$1" "$2" svd >>"${name}_reference.txt"
    [ -z "$openblas" ] || theirs "$openblas" openblas "$1" "$2" svd >>"${name}_openblas.txt"
    [ -z "$openblas" ] || theirs "$openblas" gram "$1" "$2" gram >>"${name}_gram.txt"
  done
  local mine blas other worst
  mine=$(least "${name}_ours.txt")
  for blas in reference openblas gram; do
    [ -e "${name}_$blas.txt" ] || { line 10 SKIP "no OpenBLAS" "-" "$1 ERA"; continue; }
    other=$(least "${name}_$blas.txt")
    worst=$("$python" tests/bench/identification_speed.py compare "$out/poles_${blas}_$1.txt" "$out/poles_ours_$1.txt" || echo 1)
    local bar=$3
    [ $blas = reference ] || bar=$4
    local words="$(awk "BEGIN { printf \"%.1f\", $other / $mine }") times ($mine ms against $other ms), poles equal to ${worst%%$'\t'*}"
    local what="$1 ERA, $2 block rows, 30 orders; NumPy with $(awk -F'\t' 'NR == 1 { print $NF }' "${name}_$blas.txt")"
    if [ $blas = gram ]; then
      line 10 beside "$words" "none" "$what, its Gram matrix instead of its singular value decomposition"
    else
      judge 10 "$words" ">= $bar times, 1e-6" "$what" "$other >= $bar * $mine && ${worst%%[!0-9.e-]*} <= 1e-6"
    fi
  done
}
if "$python" -c 'import scipy.linalg' 2>/dev/null; then
  compare_update plain 100 10 5
  compare_update cva 20 5 5
else
  line 10 SKIP "no python3-scipy" ">= 10 and 5 times" "one update against NumPy"
fi

# Instructions of one update: of five runs less those of one, so that making the data does not count.
instructions() { # CHANNELS UPDATES
  local count
  count=$(perf stat -x, -e instructions:u "$speed" service "$1" "$2" 2>&1 >/dev/null | awk -F, '$3 ~ /instructions/ && $1 + 0 > 0 { print $1 }' || true)
  [ -n "$count" ] || count=$(valgrind --tool=callgrind --callgrind-out-file=/dev/null "$speed" service "$1" "$2" 2>&1 | awk '/Collected/ { print $4 }')
  echo "${count:-0}"
}
for channels in 7 12; do
  one=$(instructions $channels 1) five=$(instructions $channels 5)
  each=$(((five - one) / 4))
  judge 10 "$(awk "BEGIN { printf \"%.3g\", $each }") instructions" "<= 1e8" \
    "the service's default update: $channels channels, 15 orders, with the maps for standard deviations" "$each > 0 && $each <= 1e8"
done

[ $misses -eq 0 ]

#!/usr/bin/env bash
# The figures of Welch's estimate and of the identification's cost. One line a figure.
#   tools/figures/identification_speed.sh [--quick] [--first-seed N] [FIGURE...]      FIGURE: some of 1 9 10 (default: all)
# --quick takes 2 rounds of the clock instead of 8, 10^6 samples. Needs, beside tools/setup.sh, Debian's python3-scipy and
# valgrind (or perf with hardware counters). The comparator runs with the reference BLAS and with OpenBLAS, each chosen by
# LD_LIBRARY_PATH; a missing OpenBLAS is unpacked into the build folder, not installed. The golden files of figure 1 and what
# they were made from are fixed: its numbers know no seed.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/identification_speed.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
all_or_named 1 9 10
rounds=8 samples=10000000
[ -z "$quick" ] || rounds=2 samples=1000000
out=build/figures/identification_speed
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh golden_tests accumulator_memory identification_speed
python=/usr/bin/python3
libraries=/usr/lib/$(gcc -print-multiarch)
speed=$bin/identification_speed

# --- 1: Welch against scipy.signal.csd --------------------------------------------------------------------------------
figure_1() {
  local worst=none verdict=MISS text
  if build/release/tests/golden_tests --gtest_filter='WelchGolden.*' --gtest_output="json:$out/golden.json" >"$out/golden.txt" 2>&1; then
    worst=$(awk -F'"' '/"worst_relative_deviation"/ { print $4 }' "$out/golden.json")
  fi
  judge 1a "worst relative deviation $worst" "<= 1e-10" \
    "Welch against the golden file: three windows, overlaps 0 ... 0.75, odd lengths, two channels" "$worst <= 1e-10"
  if "$python" -c 'import scipy.signal' 2>/dev/null; then
    ! text=$("$python" tests/golden/make_welch_golden.py --check) || verdict=ok
    line 1b $verdict "$text" "<= 1e-10" "the golden file against the installed scipy"
  else
    line 1b SKIP "no python3-scipy" "<= 1e-10" "the golden file against the installed scipy"
  fi
}

# --- 9: the accumulator -----------------------------------------------------------------------------------------------
figure_9() {
  local verdict=MISS
  ! "$bin/accumulator_memory" "$samples" "$first_seed" >"$out/memory.txt" || verdict=ok
  line 9 $verdict "$(tr '\t\n' ' ;' <"$out/memory.txt")" "no allocation, no byte more" "12 channels, segments of 1024, hops of 512"
}

# --- 10: one update ---------------------------------------------------------------------------------------------------
find_openblas() { # sets openblas, empty if there is none
  openblas=$libraries/openblas-pthread
  if [ ! -e "$openblas/libblas.so.3" ]; then
    local unpacked=$PWD/$out/openblas
    [ -e "$unpacked" ] || (mkdir -p "$unpacked.new" && cd "$unpacked.new" && apt-get download -qq libopenblas0-pthread 2>/dev/null &&
      dpkg -x libopenblas0-pthread*.deb . && mv "$unpacked.new" "$unpacked") || true
    openblas=$unpacked$libraries/openblas-pthread
  fi
  [ -e "$openblas/libblas.so.3" ] || openblas=""
}
ours() { # METHOD BLOCK_ROWS
  "$speed" run "$out/motion.bin" "$1" "$2" 5 "$out/poles_ours_$1.txt"
}
theirs() { # LIBRARIES NAME METHOD BLOCK_ROWS FACTORISER
  OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 LD_LIBRARY_PATH=$1 "$python" tests/bench/identification_speed.py \
    "$out/motion.bin" "$3" "$4" 3 "$out/poles_$2_$3.txt" "$5"
}
least() { # FILE: milliseconds
  awk '{ if (m == "" || $1 + 0 < m) m = $1 + 0 } END { if (m == "") print "nan"; else printf "%.2f", m }' "$1"
}

# The comparator factorises like this project, by the eigenvectors of the Gram matrix, with the same weights; the singular
# value decomposition of the matrix itself, as in most programs, is printed for comparison.
compare_update() { # METHOD BLOCK_ROWS REFERENCE_BAR OPENBLAS_BAR
  local name=$out/ms_$1 r factoriser
  rm -f "$name"_*.txt
  for ((r = 0; r < rounds; ++r)); do # alternately, so that other load of the machine affects all
    ours "$1" "$2" >>"${name}_ours.txt"
    for factoriser in gram svd; do
      theirs "$libraries/blas:$libraries/lapack" "reference_$factoriser" "$1" "$2" $factoriser >>"${name}_reference_$factoriser.txt"
      [ -z "$openblas" ] || theirs "$openblas" "openblas_$factoriser" "$1" "$2" $factoriser >>"${name}_openblas_$factoriser.txt"
    done
  done
  local blas bar mine
  mine=$(least "${name}_ours.txt")
  for blas in reference openblas; do
    bar=$3
    [ $blas = reference ] || bar=$4
    [ -e "${name}_${blas}_gram.txt" ] || { line 10 SKIP "no OpenBLAS" ">= $bar times, poles equal to 1e-6" "$1 ERA"; continue; }
    for factoriser in gram svd; do update_line "$1" "$2" ${blas}_$factoriser "$bar" "$mine"; done
  done
}
update_line() { # METHOD BLOCK_ROWS COMPARATOR BAR OUR_MS
  local other worst words what times file=$out/ms_$1_$3.txt
  other=$(least "$file")
  worst=$("$python" tests/bench/identification_speed.py compare "$out/poles_$3_$1.txt" "$out/poles_ours_$1.txt" || echo none)
  worst=${worst%%$'\t'*}
  times=$(awk "BEGIN { printf \"%.2f\", $other / $5 }")
  words="$times times ($5 ms against $other ms), poles equal to $worst"
  what="$1 ERA, $2 block rows, 30 orders; NumPy with $(awk -F'\t' 'NR == 1 { print $NF }' "$file"), $3"
  case $3 in
  *gram) judge 10 "$words" ">= $4 times, poles equal to 1e-6" "$what, as ours" "$other >= $4 * $5 && $worst <= 1e-6" ;;
  *) line 10 beside "$words" "none" "$what of the matrix itself" ;;
  esac
}
# Instructions of one update: five runs minus one run, so that making the data does not count.
instructions() { # CHANNELS UPDATES
  local count
  count=$(perf stat -x, -e instructions:u "$speed" service "$1" "$2" "$first_seed" 2>&1 >/dev/null | awk -F, '$3 ~ /instructions/ && $1 + 0 > 0 { print $1 }' || true)
  [ -n "$count" ] || count=$(valgrind --tool=callgrind --callgrind-out-file=/dev/null "$speed" service "$1" "$2" "$first_seed" 2>&1 | awk '/Collected/ { print $4 }')
  echo "${count:-0}"
}
figure_10() {
  local openblas channels one five each
  find_openblas
  "$speed" make "$out/motion.bin" "$first_seed"
  if "$python" -c 'import scipy.linalg' 2>/dev/null; then
    compare_update plain 100 10 5
    compare_update cva 20 10 5
  else
    line 10 SKIP "no python3-scipy" ">= 10 and 5 times" "one update against NumPy"
  fi
  for channels in 7 12; do
    one=$(instructions $channels 1) five=$(instructions $channels 5)
    each=$(((five - one) / 4))
    judge 10 "$(awk "BEGIN { printf \"%.3g\", $each }") instructions" "<= 1e8" \
      "the service's default update: $channels channels, 15 orders, with the maps for standard deviations" "$each > 0 && $each <= 1e8"
  done
}

run_figures "${figures[@]}"

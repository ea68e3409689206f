#!/usr/bin/env bash
# The figures of Welch's estimate and of the identification's cost. One line a figure.
#   tools/figures/identification_speed.sh [--quick] [--first-seed N] [FIGURE...]      FIGURE: some of 1 5 9 10 (default: all)
# --quick takes 2 rounds of the clock instead of 8, 10^6 samples. Needs, beside tools/setup.sh, Debian's python3-scipy and
# valgrind (or perf with hardware counters). The comparator runs with the reference BLAS and with OpenBLAS, each chosen by
# LD_LIBRARY_PATH; a missing OpenBLAS is unpacked into the build folder, not installed. Figure 5 also runs pyOMA2, where
# build/beside/pyOMA2 holds it (https://github.com/dagghe/pyOMA2). The golden files of figure 1 and what
# they were made from are fixed: its numbers know no seed.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/identification_speed.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
all_or_named 1 5 9 10
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

# --- 5, 10: one update ------------------------------------------------------------------------------------------------
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
motion() { "$speed" make "$out/motion_$1.bin" "$1" "$first_seed"; } # CHANNELS: 300 s of so many
ours() { # CHANNELS METHOD BLOCK_ROWS
  "$speed" run "$out/motion_$1.bin" "$1" "$2" "$3" 5 "$out/poles_ours_$1_$2.txt"
}
with_blas() { # LIBRARIES COMMAND...: one thread
  local libraries=$1
  shift
  OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 LD_LIBRARY_PATH=$libraries "$python" "$@"
}
theirs() { # BLAS FACTORISER CHANNELS METHOD BLOCK_ROWS
  local blas=$openblas
  [ "$1" = openblas ] || blas=$libraries/blas:$libraries/lapack
  with_blas "$blas" tests/bench/identification_speed.py "$out/motion_$3.bin" "$3" "$4" "$5" 3 "$out/poles_$1_$2_$3_$4.txt" "$2"
}
least() { # FILE: milliseconds
  awk '{ if (m == "" || $1 + 0 < m) m = $1 + 0 } END { if (m == "") print "nan"; else printf "%.2f", m }' "$1"
}

# The comparator factorises like this project, by the eigenvectors of the Gram matrix, with the same weights; the singular
# value decomposition of the matrix itself, as in most programs, is printed for comparison.
compare_update() { # FIGURE CHANNELS METHOD BLOCK_ROWS BLAS:BAR...
  local figure=$1 channels=$2 method=$3 rows=$4 name=$out/ms_$2_$3 r blas factoriser
  shift 4
  rm -f "${name}"_*.txt
  for ((r = 0; r < rounds; ++r)); do # alternately, so that other load of the machine affects all
    ours "$channels" "$method" "$rows" >>"${name}_ours.txt"
    for blas in "$@"; do
      [ "${blas%:*}" = reference ] || [ -n "$openblas" ] || continue
      for factoriser in gram svd; do
        theirs "${blas%:*}" $factoriser "$channels" "$method" "$rows" >>"${name}_${blas%:*}_$factoriser.txt"
      done
    done
  done
  for blas in "$@"; do
    [ -e "${name}_${blas%:*}_gram.txt" ] || { line "$figure" SKIP "no OpenBLAS" ">= ${blas#*:} times, poles equal to 1e-6" "$method ERA"; continue; }
    for factoriser in gram svd; do update_line "$figure" "$channels" "$method" "$rows" "${blas%:*}" $factoriser "${blas#*:}"; done
  done
}
update_line() { # FIGURE CHANNELS METHOD BLOCK_ROWS BLAS FACTORISER BAR
  local mine other worst words what times file=$out/ms_$2_$3_$5_$6.txt
  mine=$(least "$out/ms_$2_$3_ours.txt") other=$(least "$file")
  worst=$("$python" tests/bench/identification_speed.py compare "$out/poles_$5_$6_$2_$3.txt" "$out/poles_ours_$2_$3.txt" || echo none)
  worst=${worst%%$'\t'*}
  times=$(awk "BEGIN { printf \"%.2f\", $other / $mine }")
  words="$times times ($mine ms against $other ms), poles equal to $worst"
  what="$2 channels, $3 ERA, $4 block rows, 30 orders; NumPy with $(awk -F'\t' 'NR == 1 { print $NF }' "$file"), $5"
  case $6 in
  gram) judge "$1" "$words" ">= $7 times, poles equal to 1e-6" "$what, factorised as ours" "$other >= $7 * $mine && $worst <= 1e-6" ;;
  *) line "$1" beside "$words" "none" "$what, singular values of the matrix itself" ;;
  esac
}
can_compare() { # FIGURE BAR
  find_openblas
  "$python" -c 'import scipy.linalg' 2>/dev/null || { line "$1" SKIP "no python3-scipy" "$2" "one update against NumPy" && return 1; }
}
figure_5() {
  local openblas channels what
  can_compare 5 ">= 5" || return 0
  for channels in 7 12 30; do
    motion $channels
    compare_update 5 $channels plain 100 openblas:5
    compare_update 5 $channels cva 20 openblas:5
    what="$channels channels, an identification with standard deviations, against pyOMA2's covariance-driven SSI, 20 block rows, 30 orders, 10 blocks"
    if [ -z "$openblas" ]; then
      line 5 SKIP "no OpenBLAS" "printed" "$what"
    elif [ -d build/beside/pyOMA2 ]; then
      pyoma_line $channels "$what"
    else
      line 5 SKIP "no build/beside/pyOMA2 (git clone https://github.com/dagghe/pyOMA2 there)" "printed" "$what"
    fi
  done
}
pyoma_line() { # CHANNELS WHAT
  local mine other
  mine=$("$speed" service "$1" 5 "$first_seed" | awk '/^least/ { print $2 }')
  other=$(with_blas "$openblas" tests/bench/identification_pyoma.py build/beside/pyOMA2 "$out/motion_$1.bin" "$1" 20)
  line 5 beside "$(awk -v o="$other" -v m="$mine" 'BEGIN { printf "%.0f", o / m }') times ($mine ms against ${other//$'\t'/, })" "printed" "$2"
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
  if can_compare 10 ">= 10 and 5 times"; then
    motion 12
    compare_update 10 12 plain 100 reference:10 openblas:5
    compare_update 10 12 cva 20 reference:10 openblas:5
  fi
  for channels in 7 12; do
    one=$(instructions $channels 1) five=$(instructions $channels 5)
    each=$(((five - one) / 4))
    judge 10 "$(awk "BEGIN { printf \"%.3g\", $each }") instructions" "<= 1e8" \
      "the service's default update: $channels channels, 15 orders, with the maps for standard deviations" "$each > 0 && $each <= 1e8"
  done
}

run_figures "${figures[@]}"

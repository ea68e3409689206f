# Figure 5 of endurance.sh: peak memory of the readers. Sourced by it.
# shellcheck shell=bash

# Each reader alone (tests/bench/reader_peak.cpp), on the worst input that its bound admits and on one beyond it. The peak is
# that of the whole process: a program that reads nothing takes 40 MB of it for its libraries.
figure_5() {
  quietly tools/build.sh reader_peak
  python3 -B tools/figures/endurance_readers.py "$bin" "$work/readers" >"$work/readers.txt" || true
  local name admitted code words refused refused_code why
  while IFS=$'\t' read -r name _ admitted code words; do
    read -r refused refused_code < <(awk -F'\t' -v name="$name" '$1 == name && $2 == "refused" { print $3, $4 }' "$work/readers.txt") || true
    why=$(awk -F'\t' -v name="$name" '$1 == name && $2 == "refused" { print $5 }' "$work/readers.txt")
    if [ -n "${refused:-}" ]; then
      judge "5.$name" "$admitted MB, exit code $code${words:+ ($words)}; beyond: $refused MB, exit code $refused_code ($why)" \
        "<= 300 MB; refused before 64 MB are taken else" "peak memory on the worst admitted input, and on one beyond" \
        "$admitted <= 300 && $refused < 64 && $refused_code == 2"
    else
      judge "5.$name" "$admitted MB, exit code $code" "<= 300 MB" "peak memory; no length is refused" "$admitted <= 300 && $code == 0"
    fi
    unset refused refused_code
  done < <(awk -F'\t' '$2 == "admitted"' "$work/readers.txt")
  [ -s "$work/readers.txt" ] || line 5 MISS "no reader was measured" "<= 300 MB" "peak memory of every reader"
}

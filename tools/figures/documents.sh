#!/usr/bin/env bash
# The figures of the documents: the paper's chain as published, tables that are the results', the data kit, fresh seeds.
#   tools/figures/documents.sh [--quick] [--first-seed N] [FIGURE...]     FIGURE: some of 1 2 3 4 (default: all)
# 1 takes some 20 minutes on two cores; --quick takes 2 seeds for 20. Published seeds are 1001 on; 1-100 are for development.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
take_arguments "tools/figures/documents.sh [--quick] [--first-seed N] [FIGURE...]" "$@"
all_or_named 1 2 3 4
seeds=20
[ -z "$quick" ] || seeds=2
out=build/figures/documents
mkdir -p "$out"
tools/setup.sh
quietly tools/build.sh hovermodal hovermodal-validate

# --- 2: the tables -------------------------------------------------------------------------------------------------------
figure_2() {
  local count valid parts verdict=MISS
  count=$(tools/figures/tables.py --count)
  read -r parts valid < <(sed -n 's/.*Of \([0-9]*\) parts \([0-9]*\) ran.*/\1 \2/p' <<<"$count")
  judge 2a "$count" "all parts have a whole result, each on a commit after which its rooms did not change, or its row says so" \
    "$valid of $parts parts ran on the present state; tables.py --check: $(tools/figures/tables.py --check >"$out/check.txt" && echo the documents say what the results say || echo they differ)" \
    "$(wc -l <"$out/check.txt") == 0 && ${parts:-0} > 0"
  local copy=$out/copy
  rm -rf "$copy" && mkdir -p "$copy"
  git ls-files -z | xargs -0 cp --parents -t "$copy"
  ! tools/figures/tables.py --check --root "$copy" >"$out/copy.txt" 2>&1 || verdict=ok
  line 2b "$verdict" "$(tail -n 1 "$out/copy.txt" | cut -c 1-120)" "passes" "the documents' test on a copy of the tree"
  # The first digit of the first measured cell of the first table.
  sed -i -E '0,/^\| [^|]* \| [^|]* \| [^|]*[0-9]/s/^(\| [^|]* \| [^|]* \| [^|0-9]*)[0-9]/\1x/' "$copy/README.md"
  verdict=MISS
  tools/figures/tables.py --check --root "$copy" >"$out/changed.txt" || verdict=ok
  line 2c $verdict "$(grep -c '^[-+]|' "$out/changed.txt" || true) lines shown" "a changed digit makes the test fail" "the same copy with one digit of README's table changed"
  rm -rf "$copy"
}

# --- 4: fresh seeds ------------------------------------------------------------------------------------------------------
# Each validation with small records and two first seeds. Comment lines and run times are not compared.
figure_4() {
  local name small where moved lines options
  while IFS=$'\t' read -r name small; do
    eval "options=($small)"
    for where in 1 2; do
      "$bin/hovermodal-validate" "$name" --first-seed $((first_seed + where - 1)) "${options[@]}" 2>"$out/$name.log" |
        grep -v '^#' | sed -E 's/\t[0-9.]+ s(\t|$)/\1/g' >"$out/seed_$where.txt" || true
    done
    lines=$(wc -l <"$out/seed_1.txt")
    moved=$(diff "$out/seed_1.txt" "$out/seed_2.txt" | grep -c '^<' || true)
    judge "4.$name" "$moved of $lines lines differ" "every selftest's numbers move" \
      "hovermodal-validate $name, first seed $first_seed against $((first_seed + 1)), $small" "$moved > 0 && $lines > 0"
  done < <(validations)
}
validations() { # the names that the program lists, each with options that keep its records small
  local records
  records="--seeds 2 --threads $(nproc)"
  "$bin/hovermodal-validate" --help | sed -n 's/^ \{20,\}\([a-z0-9-]*\): .*/\1/p' | while read -r name; do
    case $name in
      signatures | shifts | pixels) printf '%s\t\n' "$name" ;;
      peaks) printf '%s\t%s\n' "$name" "--seeds 2" ;;
      speed) ;; # frames per second differ from run to run, whatever the seed
      klt) printf '%s\t%s\n' "$name" "--frames 3" ;;
      geometry-pixels*) printf '%s\t%s\n' "$name" "--seeds 1 --threads $(nproc) --duration 24 --report $out/pixels" ;;
      table1) printf '%s\t%s\n' "$name" "$records --duration 60 --report $out/table1" ;;
      low-frequency*) printf '%s\t%s\n' "$name" "$records --duration 300" ;;
      geometry* | paper | wind* | deck* | elevation* | noise-floor*) printf '%s\t%s\n' "$name" "$records --duration 60" ;;
      closure-clip-foreign) printf '%s\t%s\n' "$name" "--duration 40 --effect 'readout time'" ;;
      closure-clip) printf '%s\t%s\n' "$name" "--duration 40 --effect 'readout time'" ;;
      closure-tracks | closure-tracks-outside | closure-tracks-foreign | closure-tracks-foreign-outside) printf '%s\t%s\n' "$name" "$records --duration 40 --effect 'readout time'" ;;
      closure-tracks*) printf '%s\t%s\n' "$name" "$records --duration 40" ;;
      closure-live) printf '%s\t%s\n' "$name" "--seeds 1 --threads $(nproc) --duration 240 --effect 'readout time'" ;;
      closure-live-null) printf '%s\t%s\n' "$name" "$records --duration 120" ;;
      *) printf '%s\t%s\n' "$name" "$records" ;;
    esac
  done
}

for part in tools/figures/documents_*.sh; do . "$part"; done
run_figures "${figures[@]}"

#!/usr/bin/env bash
# Results that travel, and proof against a contact sensor.
#   tools/figures/exchange.sh [--quick] [--seeds N] [--first-seed N] [FIGURE...]     FIGURE: 1 2 3 4 5 (default: all)
# 1 reads every format back by readers of others: pyuff, scipy.io, mcap. Nobody installs them here; where Python does not
# find them, EXCHANGE_READERS names the folders that hold them, separated by colons:
#   pip install --target readers pyuff scipy mcap     # or Debian's python3-scipy and the sources of pyuff and mcap
#   EXCHANGE_READERS=readers tools/figures/exchange.sh 1
# 4 needs Debian's chromium (tools/setup.sh --ground). It keeps a picture of every section and a PDF of every page in
# build/figures/exchange/report.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tools/figures/lib.sh
. tools/figures/exchange_sensor.sh
. tools/figures/exchange_pages.sh
take_arguments "tools/figures/exchange.sh [--quick] [--seeds N] [--first-seed N] [FIGURE...]" "$@"
all_or_named 1 2 3 4 5
draws 1 2 4 5
bin=$PWD/$bin
out=$PWD/build/figures/exchange
mkdir -p "$out"
set_up # shellcheck disable=SC2119
quietly tools/build.sh hovermodal hovermodald
export PYTHONPATH=${EXCHANGE_READERS:+$EXCHANGE_READERS:}${PYTHONPATH:-}

# Three runs: a building from a clip; a deck with both axes, in px, with a region lost for a second; a filmed frame, or, without
# measured data, a building from tracks.
make_runs() {
  rm -rf "$out/runs" && mkdir -p "$out/runs"
  printf 'preset: paper\nduration_s: 60\nseed: %s\n' "$first_seed" >"$out/runs/building.yaml"
  quietly "$bin/hovermodal" simulate --scene "$out/runs/building.yaml" --size 480x270 --out "$out/runs/building_clip"
  quietly "$bin/hovermodald" --config "$out/runs/building_clip/config.yaml" --set telemetry.lcm_url= --set spectrum.segment=256 \
    --report "$out/runs/building"
  quietly "$bin/hovermodal" simulate --preset deck --seed "$first_seed" --duration 60 --tracks-only --out "$out/runs/deck_tracks"
  awk -F, '!/^#/ && $4 == lost && $1 >= 400 && $1 < 430 { next } { print }' lost="$(awk -F, '/^0,/ { print $4; exit }' "$out/runs/deck_tracks/tracks.csv")" \
    "$out/runs/deck_tracks/tracks.csv" >"$out/runs/tracks.csv"
  mv "$out/runs/tracks.csv" "$out/runs/deck_tracks/tracks.csv"
  # No length is known.
  sed -i -E -e 's/^( *axis:) .*/\1 both/' -e '/^scale:/d' -e '/^ +(known_length_mm|from|to):/d' "$out/runs/deck_tracks/config.yaml"
  sed -i '/^# axes:/d' "$out/runs/deck_tracks/tracks.csv"
  quietly "$bin/hovermodal" replay --tracks "$out/runs/deck_tracks/tracks.csv" --config "$out/runs/deck_tracks/config.yaml" --report "$out/runs/deck"
  if [ -d "$data/knex_frame_video" ]; then
    knex_config >"$out/runs/frame.yaml"
    quietly "$bin/hovermodald" --config "$out/runs/frame.yaml" --report "$out/runs/frame"
  else
    echo "# no data at $data (tools/data.sh brings it): the third run is a building from tracks"
    quietly "$bin/hovermodal" simulate --preset cantilever --seed "$first_seed" --duration 60 --tracks-only --out "$out/runs/frame_tracks"
    quietly "$bin/hovermodal" replay --tracks "$out/runs/frame_tracks/tracks.csv" --config "$out/runs/frame_tracks/config.yaml" --report "$out/runs/frame"
  fi
}

figure_1() {
  local run format
  make_runs
  for run in building deck frame; do
    for format in uff mat csv mcap; do
      quietly "$bin/hovermodal" export "$out/runs/$run" --to $format --out "$out/runs/$run.$format" --force
    done
    for format in uff mat; do
      quietly "$bin/hovermodal" identify --series "$out/runs/$run.$format" --report "$out/runs/$run.$format.report"
    done
    quietly "$bin/hovermodal" identify --series "$out/runs/$run/displacements.csv" --report "$out/runs/$run.own.report"
  done
  # Per format: SKIP or the numbers compared and those that differ, and the reader.
  local n_different n_compared reader
  while IFS=$'\t' read -r format n_compared n_different reader; do
    if [ "$n_compared" = SKIP ]; then
      line "1.$format" SKIP "$reader" "numbers equal" "$format read back; EXCHANGE_READERS names the folder of the reader (head of tools/figures/exchange.sh)"
    else
      judge "1.$format" "$n_compared numbers compared, $n_different differ" "numbers equal" "three runs, $reader" "$n_compared > 0 && $n_different == 0"
    fi
  done < <(python3 -B tools/figures/exchange_readers.py "$out/runs" building deck frame)
}

run_figures "${figures[@]}"

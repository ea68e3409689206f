# Figures 4 and 5 of exchange.sh, which sources this: the report in a browser, and the magnified video.
# shellcheck disable=SC2154 # bin, out, first_seed, quick: of exchange.sh and lib.sh

# Three pages: a building from a clip with everything that a page can hold (an effect that the model lacks, a comparison, notes); a
# deck with both axes; a time series in which no mode is found.
make_pages() {
  local pages=$out/pages
  rm -rf "$pages" && mkdir -p "$pages"
  printf 'preset: paper\nduration_s: 60\nseed: %s\n' "$first_seed" >"$pages/building.yaml"
  quietly "$bin/hovermodal" simulate --scene "$pages/building.yaml" --size 640x360 --out "$pages/clip"
  quietly "$bin/hovermodald" --config "$pages/clip/config.yaml" --set telemetry.lcm_url= --set spectrum.segment=256 --set closure.adopt=report \
    --set camera.readout_ms=1 --set "report.title=Six-storey frame" --set "report.compare=$pages/clip/truth.json" \
    --set 'report.notes=["date: 2026-05-04", "place: laboratory, shaking table", "structure: six storeys, steel, 2.9 m", "operator: A. Example", "Wind from the west, gusty."]' \
    --report "$pages/building"
  quietly "$bin/hovermodal" simulate --preset deck --seed "$first_seed" --duration 60 --tracks-only --out "$pages/deck_tracks"
  sed -i -E 's/^( *axis:) .*/\1 both/' "$pages/deck_tracks/config.yaml"
  sed -i '/^# axes:/d' "$pages/deck_tracks/tracks.csv"
  quietly "$bin/hovermodal" replay --tracks "$pages/deck_tracks/tracks.csv" --config "$pages/deck_tracks/config.yaml" --report "$pages/deck"
  awk -v seed="$first_seed" 'BEGIN { srand(seed); print "t_s,low,middle,high_up_on_the_tower"; for (i = 0; i < 1500; i++) {
    w = sin(2 * 3.14159265 * 3 * i / 25); printf "%.2f,%.4f,%.4f,%.4f\n", i / 25, rand() + .02 * w, rand() + .05 * w, rand() + .1 * w } }' >"$pages/noise.csv"
  quietly "$bin/hovermodal" identify --series "$pages/noise.csv" --report "$pages/noise"
}

# A page with a fault of every kind: each check must find one.
checks_can_fail() {
  local faulty=$out/faulty
  rm -rf "$faulty" && mkdir -p "$faulty"
  cat >"$faulty/report.html" <<'PAGE'
<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width"></head><body style="background:#fff">
<p style="width:2000px">wide</p><p style="color:#999">pale</p><p style="overflow:hidden;width:60px;white-space:nowrap">cut at the right side</p>
<button style="outline:none">unmarked</button><img src="http://127.0.0.1:9/a.png" alt="a"></body></html>
PAGE
  python3 -B tools/figures/exchange_report.py "$faulty/report" "$faulty/report.html" |
    awk -F'\t' '$3 > 0 { n++ } END { if (n != 5) print "the checks find " n + 0 " of 5 faults"; exit n != 5 }' >&2
}

figure_4() {
  local check measured n_faults first bar
  if ! quietly tools/setup.sh --ground || ! command -v chromium >/dev/null; then
    line 4 SKIP "chromium is missing" "no overflow at 390, 768, 1280, 1920 px and in print" "report in Chromium; tools/setup.sh --ground installs it"
    return
  fi
  checks_can_fail
  make_pages
  rm -rf "$out/report"
  while IFS=$'\t' read -r check measured n_faults first; do
    case $check in
      width) bar="no horizontal overflow at 390, 768, 1280, 1920 px" ;;
      print) bar="no horizontal overflow in print" ;;
      contrast) bar="contrast: at least 4.5, of large text 3" ;;
      keyboard) bar="keyboard: every control is reached and works, with a visible focus" ;;
      network) bar="no network" ;;
    esac
    judge "4.$check" "$measured, $n_faults faults${first:+: $first}" "$bar" "report of a building, a deck and a series without modes, light and dark" \
      "$n_faults == 0"
  done < <(python3 -B tools/figures/exchange_report.py "$out/report" "$out"/pages/{building,deck,noise}/report.html)
}

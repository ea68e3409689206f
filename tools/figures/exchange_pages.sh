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

# The demo's modes, each magnified; the service tracks the regions of the video.
figure_5() {
  local magnified=$out/magnified size=1600x900 n_modes mode worst n_regions n_held
  [ -z "$quick" ] || size=640x360
  rm -rf "$magnified" && mkdir -p "$magnified"
  quietly "$bin/hovermodal" simulate --scene tools/scenes/facade.yaml --duration 60 --seed "$first_seed" --size "$size" --out "$magnified/demo"
  quietly "$bin/hovermodald" --config "$magnified/demo/config.yaml" --set telemetry.lcm_url= --report "$magnified/demo"
  n_modes=$(python3 -c 'import json, sys; print(len(json.load(open(sys.argv[1]))["modes"]))' "$magnified/demo/modal.json")
  for ((mode = 1; mode <= n_modes; mode++)); do
    "$bin/hovermodal" magnify "$magnified/demo" --mode "$mode" --plain --seconds 12 --json --out "$magnified/mode$mode.mp4" >"$magnified/mode$mode.json"
    sed -e "s|source:.*|source: $magnified/mode$mode.mp4|" -e '/readout_/d' "$magnified/demo/config.yaml" >"$magnified/mode$mode.yaml"
    quietly "$bin/hovermodald" --config "$magnified/mode$mode.yaml" --set telemetry.lcm_url= --set spectrum.segment=128 --set closure.adopt=off \
      --report "$magnified/mode$mode"
    python3 -B tools/figures/exchange_magnified.py "$magnified/mode$mode.json" "$magnified/mode$mode/tracks.csv" >"$magnified/mode$mode.txt"
    read -r n_regions n_held worst < <(awk -F'\t' '$5 == "-" { n++; e = $4 == "nan" ? "nan" : 100 * $4 / $2; if (e == "nan" || e > w) w = e } $5 != "-" { h++ }
      END { print n + 0, h + 0, w }' "$magnified/mode$mode.txt")
    judge "5.$mode" "$(hz_of "$magnified/mode$mode.json"): $n_regions regions, worst ${worst:0:5} %; $n_held held still" \
      "motion of regions measured by our own tracker = factor x shape within 5 %" "magnified video of the demo's modes, seed $first_seed, $size" \
      "$n_regions > 0 && $worst <= 5"
  done
  judge 5 "$n_modes modes magnified" "at least 1" "modes of the demo, seed $first_seed" "$n_modes >= 1"
}
hz_of() { python3 -c 'import json, sys; d = json.load(open(sys.argv[1])); print("%.3f Hz x %g" % (d["frequency_hz"], d["factor"]))' "$1"; }

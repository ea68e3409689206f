# Figure 5 of real footage: regions as proposed against regions as declared. Sourced by footage.sh.

# structural MODAL_JSON: number of modes.
structural() {
  python3 -c 'import json, sys; print(sum(m.get("verdict", "structural") == "structural" for m in json.load(open(sys.argv[1]))["modes"]))' "$1" 2>/dev/null || echo 0
}

proposed_scene() { # NAME
  local dir=$out/scene_$1 declared proposed n code=0
  rm -rf "$dir"
  quietly "$bin/hovermodal" simulate --scene "tools/scenes/$1.yaml" --duration 60 --seed "$first_seed" --out "$dir" || { line 5 MISS "no clip" "-" "$1"; return; }
  "$bin/hovermodal" regions "$dir/clip.mp4" --out "$dir/regions.yaml" >"$dir/regions.txt" 2>&1 || code=$?
  awk '/^regions:/ { skip = 1; next } /^[a-z]/ { skip = /^scale:/ } !skip' "$dir/config.yaml" >"$dir/proposed.yaml"
  cat "$dir/regions.yaml" >>"$dir/proposed.yaml"
  quietly "$bin/hovermodald" --config "$dir/config.yaml" --set telemetry.lcm_url= --report "$dir/declared" || true
  quietly "$bin/hovermodald" --config "$dir/proposed.yaml" --set telemetry.lcm_url= --report "$dir/proposed" || true
  declared=$(structural "$dir/declared/modal.json") proposed=$(structural "$dir/proposed/modal.json")
  n=$(grep -c 'name:' "$dir/regions.yaml" || true)
  judge 5 "$n regions proposed (exit code $code): $proposed modes; with the declared ones $declared" "as many modes as with declared regions" \
    "$1, 60 s" "$proposed >= $declared && $declared > 0"
}

# The filmed frame: rows of dots at these heights, by the centroids of its first frame; a storey has a region if the region
# contains a row's height.
storeys() {
  local clip=$data/knex_frame_video/knex_1300x2046_gray.mp4
  [ -e "$clip" ] || { line 5 SKIP "no data at $clip" "a region a storey" "filmed frame"; return; }
  "$bin/hovermodal" regions "$clip" --rate-hz 20 --seconds 29 --most 24 --out "$out/knex.yaml" --picture "$out/knex.png" --force >"$out/knex.txt" 2>&1 || true
  local words
  words=$(python3 - "$out/knex.yaml" <<'P'
import re, sys
rects = [list(map(float, m.group(1).split(","))) for m in re.finditer(r"rect: \[([^]]*)\]", open(sys.argv[1]).read())]
rows = {"row1": 1420, "row2": 930, "roof": 470}  # of the configuration used by the other figures of this clip
held = [name for name, v in rows.items() if any(r[1] - 60 <= v <= r[1] + r[3] + 60 for r in rects)]
print(len(rects), len(held), ",".join(held) or "none")
P
  ) || words="0 0 none"
  # shellcheck disable=SC2086
  set -- $words
  judge 5 "$1 regions, storeys with one: $3" "at least one region a storey" "filmed frame, three storeys, corners move by up to 170 px" "$2 == 3"
}

figure_5() {
  local scene scenes="paper calm shear_frame bridge_deck cantilever undeclared"
  [ -z "$quick" ] || scenes="paper bridge_deck"
  for scene in $scenes; do proposed_scene "$scene"; done
  storeys
}

# Figure 11b of residual diagnosis: compressed clips. Sourced by closure.sh after closure_foreign_clips.sh.

figure_11b() {
  local codec bits i name kept false_ones=0 n=0 named=0 given_way=0 said=$out/codec_readout.txt adopts right away words
  # What was found in each clip is kept: a run that was cut off goes on, a change of what is measured begins anew.
  kept=$out/codec-$(python3 tools/figures/tables.py --rooms closure_11b | sha256sum | cut -c1-16)
  mkdir -p "$kept"
  : >"$said"
  for codec in libx264 libx265; do
    for bits in 0.05 0.15 0.4; do
      for ((i = 0; i < coded_clips; i++)); do
        name=codec_${codec}_${bits}_$i n=$((n + 1))
        if [ ! -e "$kept/$name-$((first_seed + i))" ]; then
          coded_pair "$name" "$((first_seed + i))" "$codec" "$bits" "$i" >"$kept/new"
          mv "$kept/new" "$kept/$name-$((first_seed + i))"
        fi
        IFS=$'\t' read -r adopts right away words < <(head -n 1 "$kept/$name-$((first_seed + i))")
        false_ones=$((false_ones + adopts)) named=$((named + right)) given_way=$((given_way + away))
        echo "# $words"
        tail -n +2 "$kept/$name-$((first_seed + i))" >>"$said"
      done
    done
  done
  judge 11b.null "$false_ones of $n" "false adoptions <= 1 in 30" "H.264 and HEVC at 0.05, 0.15, 0.4 bits a pixel" "$false_ones <= $n / 30"
  judge 11b.named "$named of $n" "readout, k1, roll named wherever their strength over the *codec's* noise is 1" "the residual of the same clip without the effect" "$named == $n"
  local mean covered values
  read -r mean covered values < <(awk -F'\t' '{ s += $1; v++; if ($2 <= 1.96) c++ } END { if (v) print s / v, c + 0, v; else print "nan 0 0" }' "$said")
  judge 11b.readout "mean error $mean of a frame, 95 % intervals hold in $covered of $values" "readout from tracks unbiased (<= 0.02 of a frame), 95 % intervals hold" \
    "declared as it is" "$mean <= 0.02 && $mean >= -0.02 && $covered >= 0.9 * $values && $values > 0"
  judge 11b.declared "$given_way of $n" "a declared value contradicted by 4 sigma gives way with a word" "readout declared wrong by 0.4 of a frame; where the tracks contradict it by less, it may stay" \
    "$given_way == $n"
}
# coded_pair NAME SEED CODEC BITS I: the clip without an effect, and with one as strong as the residual of the former. A line: adopts
# anything (1 or 0), the effect named and nothing else, a wrong declaration gives way, words; then the error of the readout.
coded_pair() {
  local name=$1 seed=$2 bits=$4 effects=("readout time" "radial distortion" "camera roll") effect clip scene_px adopts=0 away right readout
  effect=${effects[$5 % 3]}
  foreign_clip "$name" "$seed"
  foreign_coded "$name" "$bits" "$3"
  clip=$PWD/$out/${name}_$bits.mp4
  foreign_closed "${name}_null" "$name" "$clip"
  [ "$(adopted "${name}_null")" = nothing ] || adopts=1
  readout=$(codec_readout "$name" "${name}_null_run")
  foreign_run "${name}_wrong" "$name" "$clip" --set "camera.readout_ms=$(codec_wrong_readout "$name")"
  away=$(codec_gives_way "$name" "${name}_wrong_run")
  scene_px=$(ask "${name}_null" '"%.4f" % (3 * c["baseline"]["residual_rms"])') # of the 1080p view that the scene describes
  foreign_clip "${name}_with" "$seed" "$effect" "$(awk "BEGIN { print $scene_px / 0.09 }")"
  foreign_coded "${name}_with" "$bits" "$3"
  foreign_closed "${name}_found" "${name}_with" "$PWD/$out/${name}_with_$bits.mp4"
  read -r right _ < <(foreign_answer "${name}_with" "${name}_found")
  rm -rf "${out:?}/$name"/clip.mp4 "${out:?}/${name}_with" "${out:?}/${name}_null_run" "${out:?}/${name}_wrong_run" "${out:?}/${name}_found_run" \
    "$clip" "$out/${name}_with_$bits.mp4"
  printf '%s\t%s\t%s\t%s\n' "$adopts" "$right" "$away" \
    "$3 $bits bits a pixel, seed $seed: without effect $(adopted "${name}_null"); $effect of $scene_px px: $(adopted "${name}_found")"
  [ -z "$readout" ] || echo "$readout"
}
# NAME RUN: error of the readout from tracks, in frames and in its sigmas. Prints nothing if there is none.
codec_readout() {
  python3 - "$out/$1/config.yaml" "$out/$2/modal.json" <<'PY'
import json, sys
text = {k.strip(): v.strip() for k, _, v in (row.partition(":") for row in open(sys.argv[1]))}
found = json.load(open(sys.argv[2]))["readout"]["from_tracks"]
if found:
    off = found["readout_ms"] - float(text["readout_ms"])
    print(off * 1e-3 * float(text["rate_hz"]), abs(off) / found["std_ms"], sep="\t")
PY
}
codec_wrong_readout() { # NAME: 0.4 of a frame off the truth, within 0 and one frame
  python3 - "$out/$1/config.yaml" <<'PY'
import sys
text = {k.strip(): v.strip() for k, _, v in (row.partition(":") for row in open(sys.argv[1]))}
frame_ms = 1e3 / float(text["rate_hz"])
true_ms = float(text["readout_ms"])
print(true_ms + (0.4 if true_ms < 0.5 * frame_ms else -0.4) * frame_ms)
PY
}
# NAME RUN: 1 if the tracks do not contradict the declared readout by 4 sigma, or another one is used.
codec_gives_way() {
  python3 - "$out/$2/modal.json" <<'PY'
import json, math, sys
r = json.load(open(sys.argv[1]))["readout"]
found, declared, used = r["from_tracks"], r["declared"], r["used"]
if not found:
    print(1)
else:
    off = abs(found["readout_ms"] - declared["readout_ms"])
    contradicted = off > 4 * math.hypot(found["std_ms"], declared["std_ms"])
    away = abs(used["readout_ms"] - found["readout_ms"]) <= 2 * found["std_ms"] and "declared" in r["why"]
    print(int(away or not contradicted))
PY
}

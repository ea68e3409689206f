# Figure 1 of documents.sh: the published chain (method: paper) on the paper's own experiment. Sourced, with lib.sh,
# $out, $first_seed and $seeds.

paper_row() { # READOUT WAY: a summary line of validate paper, columns by name
  awk -F'\t' -v readout="$1" -v way="$2" '$1 == "paper" && $2 == readout && $3 == way { $1 = $2 = $3 = ""; print }' "$out/paper.txt"
}
read_paper_row() { # READOUT WAY: into variables, "nan" where there is no such line
  n=0 complete=0 n_false=nan
  real=(nan nan nan) complex=(nan nan nan) worst=(nan nan nan) hz=(nan nan nan) found=(0 0 0)
  local cells mode at
  read -ra cells < <(paper_row "$@") || return 0
  n=${cells[0]} complete=${cells[1]} n_false=${cells[23]}
  for mode in 0 1 2; do
    at=$((2 + 7 * mode))
    found[mode]=${cells[at]} hz[mode]=${cells[at + 2]} real[mode]=${cells[at + 3]} worst[mode]=${cells[at + 4]} complex[mode]=${cells[at + 5]}
  done
}
paper_words() {
  echo "3 of 3 modes in $complete of $n; real MAC median ${real[*]}, worst ${worst[*]}; complex MAC median ${complex[*]};" \
    "frequency worst ${hz[*]} %; per record $n_false poles called a mode that are none"
}

figure_1() {
  local bar="3 of 3 modes in at least 18 of 20, real MAC median at least .9999 / .998 / .996"
  local flight=$data/phantom4_hover/flight_10hz.csv moved_by="hover recorded in flight" use_flight readout way
  use_flight=(--flight "$flight")
  if [ ! -f "$flight" ]; then
    line 1 SKIP "no data at $flight" "-" "recorded hover (HOVERMODAL_DATA names the folder): the hover model moves the camera instead"
    moved_by="modelled hover" use_flight=()
  fi
  "$bin/hovermodal-validate" paper --seeds "$seeds" --first-seed "$first_seed" --threads "$(nproc)" "${use_flight[@]}" >"$out/paper.txt"
  local parts=([40]=1a [26]=1b)
  for readout in 40 26; do
    read_paper_row "$readout" paper
    judge "${parts[readout]}" "$(paper_words)" "$bar" \
      "method: paper, the paper's experiment, 300 s, $moved_by, readout $readout ms of a frame of 40, seeds $first_seed-$((first_seed + seeds - 1))" \
      "$n == $seeds && $complete * 20 >= 18 * $n && ${real[0]} + 0 >= .9999 && ${real[1]} + 0 >= .998 && ${real[2]} + 0 >= .996"
    for way in region ours; do
      read_paper_row "$readout" "$way"
      line "${parts[readout]}" beside "$(paper_words)" "none" "the same tracks: ${way/region/paper.velocity: region}"
    done
  done
}

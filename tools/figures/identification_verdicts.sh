# Figures 7 and 8 of the identification: modes above half the frame rate, and motion that is no mode. Sourced by
# identification.sh.

# --- 7: above half the frame rate ---------------------------------------------------------------------------------------
figure_7() {
  check folding "$seeds"
  folding_parts "" '$2 ~ /^parts/' '$5 > 12' "readout 0.66 and 0.9 of a frame, 300 and 600 s, noise 0.003 and 0.1 px" '$n == 48'
  folding_parts -drawn '1' '$5 ~ /^folded/' "readout 0.66 and 0.9 of a frame, 300 and 600 s, the rest drawn" '$n >= 8'
  folding_base "" '$5 < 14' '$n == 24'
  folding_base -drawn '$5 !~ /weak/' '$n >= 8'
  folding_ambiguous "" '$5 > 5.01' '$n == 20'
  folding_ambiguous -drawn '$5 !~ /^alone/' '$n >= 8'
  folding_readout ""
  folding_readout -drawn
}
# Number of rows; least share found; of 600 s: worst error and least share of MAC >= 0.98 of the modes of FOLDED, least share
# certain and right; certain and wrong.
folding_parts() { # SUFFIX ROWS FOLDED WHAT CONDITION
  local n least worst mac right wrong
  read -r n least worst mac right wrong _ < <(table folding "\$1 == \"folding$1\" && \$2 ~ /^parts/ && $2" \
    "s = \$6 > 0 ? 100 / \$6 : 0; if (least == \"\" || s * \$7 < least) least = s * \$7; wrong += \$9
     if (\$4 == 600) { r = s * \$8; if (right == \"\" || r < right) right = r
       if ($3) { e = size(num(\$12)); if (e > w) w = e; if (mac == \"\" || s * \$14 < mac) mac = s * \$14 } }" \
    'print n, least, w + 0, mac, right, wrong')
  judge "7a$1" "found at least $least %; 600 s: modes above half the rate worst $worst %, MAC >= 0.98 in at least $mac %, certain and right in $right %; certain and wrong $wrong" \
    "all found, 0.25 %, 98 %, 98 %, never" "modes at 1 : .2 : .08 : .04 : .02 : .012 of the roof, $4, $(seeds_of "$seeds")" \
    "${5/\$n/$n} && $least == 100 && $worst <= 0.25 && $mac >= 98 && $right >= 98 && $wrong == 0"
}
folding_base() { # SUFFIX CLEAR-MODES CONDITION
  local n right wrong weak
  read -r n right wrong weak _ < <(table folding "\$1 == \"folding$1\" && \$2 == \"base\"" \
    "s = \$6 > 0 ? 100 / \$6 : 0; wrong += \$9; if ($2) { if (right == \"\" || s * \$8 < right) right = s * \$8 } else if (weak == \"\" || s * \$8 < weak) weak = s * \$8" \
    'print n, right, wrong, weak == "" ? "-" : weak')
  judge "7b$1" "$([ -z "$1" ] && echo "modes 1-5" || echo "modes 20 dB above the noise") right in at least $right %, others in at least $weak %; certain and wrong $wrong" \
    "modes 1-5 right, mode 6 right, ambiguous or absent, never wrong and certain" \
    "the same with white base acceleration$([ -n "$1" ] || echo " (mode 6 then moves the roof by 0.0007 px)")" \
    "${3/\$n/$n} && $right == 100 && $wrong == 0"
}
folding_ambiguous() { # SUFFIX MODES-WITH-A-RIVAL CONDITION
  local n certain ambiguous
  read -r n certain ambiguous _ < <(table folding "\$1 == \"folding$1\" && (\$2 == \"span-0.1\" || \$2 == \"two-channels\") && $2" \
    's = $6 > 0 ? 100 / $6 : 0; c += $8 + $9; if (a == "" || s * $10 < a) a = s * $10' 'print n, c, a')
  judge "7c$1" "called certain $certain times, ambiguous in at least $ambiguous %" "ambiguous" \
    "rows over a tenth of the image, or two channels: modes that have a rival below 0.8 of the rate" \
    "${3/\$n/$n} && $certain == 0 && $ambiguous == 100"
}
folding_readout() { # SUFFIX
  local n worst missing
  read -r n worst missing _ < <(table folding "\$1 == \"folding-readout$1\" && \$5 == \"stated\"" \
    'e = size(num($10)); if (e > w) w = e; missing += $6 - $7' 'print n, w, missing')
  judge "7d$1" "worst $worst, none in $missing records" "0.03" "readout time read off the shapes, frames" \
    "$n == 4 && $missing == 0 && $worst <= 0.03"
}

# --- 8: what is no mode -------------------------------------------------------------------------------------------------
figure_8() {
  figure_8_null
  check harmonics "$seeds"
  local suffix n share
  for suffix in "" -drawn; do
    read -r n share _ < <(table harmonics "\$1 == \"rotor$suffix\"" 's = 100 * ($6 + $8) / $3; if (w == "" || s < w) w = s' 'print n, w')
    judge "8b$suffix" "at least $share %" "95 of 100" "a wandering rotor line called camera motion or harmonic, $(seeds_of "$seeds")" \
      "$n == 2 && $share >= 95"
  done
  harmonic_lines "" '$2 == 1.0'
  harmonic_lines -drawn '1'
}
figure_8_null() {
  local flight=$data/phantom4_hover/flight_10hz.csv hover="hover recorded in flight" suffix n records use_flight=()
  if [ -f "$flight" ]; then
    use_flight=(--flight "$flight")
  else
    line 8a SKIP "no data at $flight" "1 of 100" "a rigid building under the recorded hover (HOVERMODAL_DATA names the folder): the hover model instead"
    hover="modelled hover"
  fi
  check null "$seeds" "${use_flight[@]}"
  for suffix in "" -drawn; do
    read -r n records _ < <(table null "\$1 == \"null$suffix\"" 'if ($4 > r) r = $4' 'print n, r + 0')
    judge "8a$suffix" "$records of $seeds records with a structural pole" "1 of 100" \
      "a rigid building, $hover, rotor line; with and without a base, $(seeds_of "$seeds")" "$n == 2 && $records <= 0.01 * $seeds"
  done
}
harmonic_lines() { # SUFFIX ROWS
  local strength n share falsely rms worst rows
  for strength in 1.0 0.3; do
    rows="\$1 == \"steady$1\" && $2 && \$3 == $strength"
    read -r n share falsely _ < <(table harmonics "$rows" 'h = 100 * $9 / $4; f = 100 * $14 / $4' 'print n, h, f')
    judge "8c$1" "harmonic in $share %; true modes so called $falsely in 100 records" "80 of 100, 2 in 100" \
      "a steady force of 600 s, its line $strength times as large as the mode beside" "$n == 1 && $share >= 80 && $falsely <= 2"
    read -r n rms worst _ < <(table harmonics "$rows" 'r = num($20); w = num($21)' 'print n, r, w')
    judge "8d$1" "rms $rms, worst $worst %" "0.2 %" \
      "the mode beside it against the same record without the line, $strength times as large" "$n == 1 && $worst <= 0.2"
  done
}

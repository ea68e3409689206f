# Figure 3 of documents.sh, which sources this: the data kit in a clean clone of the last commit, with the tests of this build.
# shellcheck shell=bash

# $out is relative to the project.
# measured_outcome DATA: "PASSED FAILED SKIPPED" of the tests labelled measured with the data in this folder.
measured_outcome() {
  HOVERMODAL_DATA=$1 ctest --test-dir build/release -L measured -j "$(nproc)" --output-junit "$PWD/$out/measured.xml" \
    --test-output-size-passed 10000000 >"$out/measured.log" 2>&1 || true
  ctest --test-dir build/release -L measured --show-only=json-v1 >"$out/measured.json"
  { tools/test_summary.py "$out/measured.xml" "$out/measured.json" || true; } | awk '/^tests:/ { print $2, $4, $6 }'
}

figure_3() {
  local before after passed failed skipped words="" refused code=0 wrong file=five_dof_example/accelerations.csv
  local what="tools/data.sh --from $data in a clean clone, then its measured tests by this build"
  if [ ! -d "$data" ]; then
    line 3a SKIP "no data at $data" "the 14 measured tests pass instead of skip" "$what"
    line 3b SKIP "no data at $data" "refused" "a wrong sha256"
    return
  fi
  quietly tools/build.sh measured_tests hovermodal
  rm -rf "$out/clone" "$out/wrong"
  quietly git clone -q --no-hardlinks . "$out/clone"
  before=$(measured_outcome "$PWD/$out/clone/data")
  "$out/clone/tools/data.sh" --from "$data" --to "$out/clone/data" >"$out/data.txt" 2>&1 || words="; data.sh: $(tail -n 1 "$out/data.txt")"
  read -r passed failed skipped <<<"$(after=$(measured_outcome "$PWD/$out/clone/data") && echo "$after")"
  judge 3a "before: $(awk '{ print $1 " passed, " $3 " skipped" }' <<<"$before"); after: $passed passed, $failed failed, $skipped skipped$words" \
    "the 14 measured tests pass instead of skip" "$what" "$passed == 14 && $failed == 0 && $skipped == 0 && \"$before\" == \"0 0 14\""

  # The same folder with one digit changed in one file of one set.
  wrong=$out/wrong
  mkdir -p "$wrong/$(dirname "$file")"
  sed '2s/[0-9]/x/' "$data/$file" >"$wrong/$file"
  refused=$("$out/clone/tools/data.sh" --from "$wrong" --to "$wrong/taken" "$(dirname "$file")" 2>&1) || code=$?
  judge 3b "exit status $code, $(find "$wrong/taken" -type f 2>/dev/null | wc -l) files taken: $(grep -m 1 refused <<<"$refused")" "refused" \
    "a wrong sha256: $file with one digit changed" "$code == 1 && $(grep -c 'refused, its sha256' <<<"$refused") == 1 && $(find "$wrong/taken" -type f 2>/dev/null | wc -l) == 0"
  rm -rf "$out/clone" "$wrong"
}

#!/usr/bin/env python3
"""What a run of ctest came to: test_summary.py RESULTS.xml TESTS.json

RESULTS.xml is of `ctest --output-junit`, TESTS.json of `ctest --show-only=json-v1` (labels). Prints "N passed, M skipped" (with "F failed"
between them where a test failed), a line for each group of skipped tests with their label and reason, the names of failed tests, and last
"tests: N passed, F failed, M skipped". Ends with 1 where a test failed or none ran.
"""
import collections
import json
import re
import sys
import xml.etree.ElementTree as ElementTree

# A test that skips itself; anything else that did not run (no executable, a fixture that failed) has failed.
SKIPPED_ITSELF = re.compile(r"SKIP_RETURN_CODE|SKIP_REGULAR_EXPRESSION")


def labels_of(path):
    with open(path, encoding="utf-8") as text:
        tests = json.load(text)["tests"]
    out = {}
    for test in tests:
        for p in test.get("properties", []):
            if p["name"] == "LABELS" and p["value"]:
                out[test["name"]] = p["value"][0]
    return out


def reason(output):
    """In the test's own words, without the place, so that equal reasons are one group."""
    lines = [line.strip() for line in output.splitlines()]
    said = ""
    for k, line in enumerate(lines):
        if re.search(r": Skipped$", line):  # GoogleTest: the message is below
            said = next((l for l in lines[k + 1:] if l), "")
            break
        if m := re.match(r"SKIP:?\s+(.*)|.*: skipped, (.*)", line):  # our scripts
            said = m.group(1) or m.group(2)
    return re.sub(r' at ("[^"]*"|\S+)', "", said) or "no reason given"


def main(results, tests):
    labels = labels_of(tests)
    n_passed, failed, groups = 0, [], collections.Counter()
    for case in ElementTree.parse(results).getroot().iter("testcase"):
        name, skipped = case.get("name"), case.find("skipped")
        if case.get("status") == "run":
            n_passed += 1
        elif case.get("status") == "disabled":
            groups[labels.get(name, "test"), "disabled"] += 1
        elif skipped is not None and SKIPPED_ITSELF.search(skipped.get("message", "")):
            groups[labels.get(name, "test"), reason(case.findtext("system-out") or "")] += 1
        else:
            failed.append(name)
    n_skipped = sum(groups.values())
    print(f"\n{n_passed} passed, {f'{len(failed)} failed, ' if failed else ''}{n_skipped} skipped")
    for (label, why), n in sorted(groups.items(), key=lambda g: (-g[1], g[0])):
        print(f"{n:4} {label}: {why}")
    for name in failed:
        print(f"FAILED {name}")
    print(f"tests: {n_passed} passed, {len(failed)} failed, {n_skipped} skipped")
    return 1 if failed or n_passed + n_skipped == 0 else 0


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))

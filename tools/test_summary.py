#!/usr/bin/env python3
"""What a run of ctest came to: test_summary.py RESULTS.xml TESTS.json

RESULTS.xml is of `ctest --output-junit --test-output-size-passed BIG`, TESTS.json of `ctest --show-only=json-v1` (labels). An entry that
ran a suite of GoogleTest counts as the tests that it started; one that did not end has failed. Prints "N passed, M skipped" (with "F
failed" between them where a test failed), a line for each group of skipped tests with their label and reason, the names of failed tests,
and last "tests: N passed, F failed, M skipped". Ends with 1 where a test failed or none ran.
"""
import collections
import json
import re
import sys
import xml.etree.ElementTree as ElementTree

# A test that skips itself; anything else that did not run (no executable, a fixture that failed) has failed.
SKIPPED_ITSELF = re.compile(r"SKIP_RETURN_CODE|SKIP_REGULAR_EXPRESSION")
STARTED = re.compile(r"\[ RUN      \] (\S+)")
ENDED = re.compile(r"\[ +(OK|FAILED|SKIPPED) +\] ([^\s,]+)(?:, where .*)? \(\d+ ms\)")


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


def tests_of(output):
    """(name, "OK" or "FAILED" or "SKIPPED", why it was skipped) of each test that GoogleTest started."""
    parts = STARTED.split(output)
    for name, text in zip(parts[1::2], parts[2::2]):
        end = next((m for m in ENDED.finditer(text) if m.group(2) == name), None)
        yield (name, end.group(1), reason(text)) if end else (f"{name} (did not end)", "FAILED", "")


def outcomes(case):
    """As tests_of; an entry that is no suite is one test, as is what failed outside of a suite's tests."""
    name, status, skipped = case.get("name"), case.get("status"), case.find("skipped")
    output = case.findtext("system-out") or ""
    tests = list(tests_of(output))
    if status == "run":
        return tests or [(name, "OK", "")]
    if status == "disabled":
        return [(name, "SKIPPED", "disabled")]
    if skipped is not None and SKIPPED_ITSELF.search(skipped.get("message", "")):
        return tests or [(name, "SKIPPED", reason(output))]
    return tests if any(end == "FAILED" for _, end, _ in tests) else tests + [(name, "FAILED", "")]


def main(results, tests):
    labels = labels_of(tests)
    n_passed, failed, groups = 0, [], collections.Counter()
    for case in ElementTree.parse(results).getroot().iter("testcase"):
        for name, end, why in outcomes(case):
            if end == "OK":
                n_passed += 1
            elif end == "FAILED":
                failed.append(name)
            else:
                groups[labels.get(case.get("name"), "test"), why] += 1
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

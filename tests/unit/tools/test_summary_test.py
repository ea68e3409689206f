#!/usr/bin/env python3
"""tools/test_summary.py on results of ctest in which everything happens."""
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SUMMARY = Path(__file__).resolve().parents[3] / "tools" / "test_summary.py"
SKIPPED = "a_test.cpp:12: Skipped\nno data at &quot;/a b/{0}&quot; (tools/data.sh brings them)\n\n[  SKIPPED ] A.b (0 ms)\n"
RUN = '<testcase name="runs" status="run"><system-out></system-out></testcase>'
MEASURED = ('<testcase name="measured_{0}" status="notrun"><skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/>'
            "<system-out>" + SKIPPED + "</system-out></testcase>")
DEVICE = ('<testcase name="device_usb" status="notrun"><skipped message="SKIP_RETURN_CODE=77"/>'
          "<system-out>device tests: skipped, no emulator (tools/setup.sh --device)</system-out></testcase>")
FAILED = '<testcase name="fails" status="fail"><failure message=""/><system-out></system-out></testcase>'
NOT_BUILT = '<testcase name="not_built" status="notrun"><skipped message="Unable to find executable"/></testcase>'
LABELS = {"measured_one": "measured", "measured_two": "measured", "device_usb": "device", "fails": "unit"}

SUITE = "Running main()\n[ RUN      ] Welch.IsEven\n[       OK ] Welch.IsEven (3 ms)\n{}[----------] tests from Welch (3 ms total)\n"


def suite(status, more, element=""):
    output = SUITE.format(more)
    return f'<testcase name="Welch" status="{status}">{element}<system-out>{output}</system-out></testcase>'


class Summary(unittest.TestCase):
    def summary_of(self, *cases):
        with tempfile.TemporaryDirectory() as folder:
            results, tests = Path(folder) / "r.xml", Path(folder) / "t.json"
            results.write_text("<testsuite>" + "".join(cases) + "</testsuite>")
            tests.write_text(json.dumps({"tests": [{"name": n, "properties": [{"name": "LABELS", "value": [l]}]} for n, l in LABELS.items()]}))
            run = subprocess.run([sys.executable, SUMMARY, results, tests], capture_output=True, text=True, timeout=60)
        self.assertEqual(run.stderr, "")
        return run.returncode, run.stdout.split("\n")

    def test_groups_what_was_skipped_by_label_and_reason(self):
        code, lines = self.summary_of(RUN, MEASURED.format("one"), DEVICE, MEASURED.format("two"))
        self.assertEqual(code, 0)
        self.assertEqual(lines, ["", "1 passed, 3 skipped", "   2 measured: no data (tools/data.sh brings them)",
                                 "   1 device: no emulator (tools/setup.sh --device)", "tests: 1 passed, 0 failed, 3 skipped", ""])

    def test_a_failure_is_counted_named_and_in_the_exit_status(self):
        code, lines = self.summary_of(RUN, FAILED, DEVICE)
        self.assertEqual(code, 1)
        self.assertEqual(lines[1], "1 passed, 1 failed, 1 skipped")
        self.assertIn("FAILED fails", lines)
        self.assertEqual(lines[-2], "tests: 1 passed, 1 failed, 1 skipped")

    def test_a_test_without_its_program_has_failed(self):
        code, lines = self.summary_of(RUN, NOT_BUILT)
        self.assertEqual(code, 1)
        self.assertEqual(lines[-2], "tests: 1 passed, 1 failed, 0 skipped")

    def test_a_suite_counts_as_its_tests(self):
        skipped = "[ RUN      ] Welch.Odd/0\na.cpp:1: Skipped\nno odd numbers\n\ncut line[  SKIPPED ] Welch.Odd/0 (0 ms)\n"
        code, lines = self.summary_of(suite("run", "[ RUN      ] Welch.Two\n[       OK ] Welch.Two (0 ms)\n" + skipped))
        self.assertEqual(code, 0)
        self.assertEqual(lines[1:], ["2 passed, 1 skipped", "   1 test: no odd numbers", "tests: 2 passed, 0 failed, 1 skipped", ""])

    def test_a_failed_test_of_a_suite_is_named(self):
        failed = "[ RUN      ] Welch.Odd/1\nno\n[  FAILED  ] Welch.Odd/1, where GetParam() = (3, a b) (1 ms)\n[  FAILED  ] 1 test, listed below:\n"
        code, lines = self.summary_of(suite("fail", failed, '<failure message=""/>'))
        self.assertEqual(code, 1)
        self.assertEqual(lines[1:], ["1 passed, 1 failed, 0 skipped", "FAILED Welch.Odd/1", "tests: 1 passed, 1 failed, 0 skipped", ""])

    def test_a_test_that_ends_the_process_has_failed_whatever_its_status(self):
        for status in ("fail", "run"):
            code, lines = self.summary_of(suite(status, "[ RUN      ] Welch.Ends\n"))
            self.assertEqual(code, 1)
            self.assertEqual(lines[1:3], ["1 passed, 1 failed, 0 skipped", "FAILED Welch.Ends (did not end)"])

    def test_what_fails_outside_of_a_suites_tests_has_the_suites_name(self):
        code, lines = self.summary_of(suite("fail", "leak\n", '<failure message=""/>'))
        self.assertEqual(code, 1)
        self.assertEqual(lines[1:3], ["1 passed, 1 failed, 0 skipped", "FAILED Welch"])

    def test_a_run_of_no_test_is_no_success(self):
        self.assertEqual(self.summary_of()[0], 1)


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""tools/figures/tables.py on a made-up project: what a result is, what a table says, what makes the check fail."""
import contextlib
import io
import os
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
sys.path.insert(0, os.path.join(ROOT, "tools", "figures"))
sys.dont_write_bytecode = True
import figure_results  # noqa: E402
import tables  # noqa: E402

RESULT = """# part: speed
# command: tools/figures/speed.sh
# commit: 0123456789abcdef0123456789abcdef01234567
# date: 2026-01-02
# seconds: 3
# room: core {digest}
# whole: yes
# a remark of the script
1a ok 12 us (bar: <= 20 us (median)) a point beside its neighbours (180 of them)
1b MISS 1/5.5 (bar: 1/8) a frame at 1080p
1c beside 3 us (bar: none) the same on another machine
"""
DOCUMENT = "Text\n<!-- figures: {what} -->\n<!-- figures end -->\nmore\n"


class Project:
    """A folder with one part, `speed`, that measures the room `core`, and one that was never run."""

    def __init__(self, what, result=RESULT):
        self.folder = tempfile.TemporaryDirectory()
        self.root = self.folder.name
        self.write("core/a.cpp", "int a;\n")
        self.write("tools/figures/parts.tsv", "speed\t1\tcore\ttools/figures/speed.sh\tspeed\nother\t9\tcore\tx\tothers\n")
        digest = figure_results.room_digest("core", self.root)
        self.write("tools/figures/results/speed.txt", result.format(digest=digest))
        self.write("README.md", DOCUMENT.format(what=what))
        self.write("tools/guide/figures.md", "none\n")

    def write(self, name, text):
        path = os.path.join(self.root, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)

    def readme(self):
        with open(os.path.join(self.root, "README.md"), encoding="utf-8") as file:
            return file.read()

    def run(self, write=False):
        with contextlib.redirect_stdout(io.StringIO()):
            return tables.compare(tables.Book(self.root), self.root, write)


class Tables(unittest.TestCase):
    def test_a_line_is_parsed_with_parentheses_in_its_bar(self):
        line = figure_results.parse_line("1a ok 12 us (worst) (bar: <= 20 us (median)) a point (180 of them)")
        self.assertEqual(line, ("1a", "ok", "12 us (worst)", "<= 20 us (median)", "a point (180 of them)"))

    def test_text_that_is_no_figure_is_no_line(self):
        self.assertIsNone(figure_results.parse_line("1a ok without a bar"))
        self.assertIsNone(figure_results.parse_line("1a fine 3 (bar: 4) what"))

    def test_misses_stand_in_the_table_like_everything_else(self):
        project = Project("part speed other")
        project.run(write=True)
        self.assertIn("| a point beside its neighbours (180 of them) | <= 20 us (median) | 12 us | ok | 0123456 |",
                      project.readme())
        self.assertIn("| a frame at 1080p | 1/8 | 1/5.5 | **MISS** | 0123456 |", project.readme())
        self.assertIn("| others (`other`) | - | not run | - | - |", project.readme())

    def test_misses_are_listed(self):
        project = Project("misses")
        project.run(write=True)
        self.assertIn("- **speed** (`speed`, 1 of 2 lines, on 0123456)\n  - asked: 1/8\n    - a frame at 1080p: 1/5.5 (1b)\n", project.readme())
        self.assertIn("not run on the delivered program: `other`", project.readme())
        self.assertNotIn("a point", project.readme())

    def test_parts_that_miss_are_counted(self):
        project = Project("missed")
        project.run(write=True)
        self.assertIn("| speed (`speed`) | 1 | 2 | as it is now |\n", project.readme())
        self.assertIn("And not run on the delivered program: `other`.", project.readme())
        project.write("core/a.cpp", "int b;\n")
        project.run(write=True)
        self.assertIn("| speed (`speed`) | 1 | 2 | before a change |\n", project.readme())

    def test_a_written_table_passes_and_a_changed_digit_fails(self):
        project = Project("part speed")
        project.run(write=True)
        self.assertEqual(project.run(), 0)
        project.write("README.md", project.readme().replace("1/5.5", "1/9.5"))
        self.assertEqual(project.run(), 1)

    def test_a_changed_room_is_named(self):
        project = Project("part speed")
        project.run(write=True)
        project.write("core/a.cpp", "int b;\n")
        self.assertEqual(project.run(), 1)
        project.run(write=True)
        self.assertIn("| 0123456; changed since: core |", project.readme())
        project.write("core/a.cpp", "int c;\n")
        self.assertEqual(project.run(), 0)

    def test_a_room_may_be_a_pattern(self):
        project = Project("part speed")
        project.write("core/b.cpp", "int b;\n")
        before = figure_results.room_digest("core/a*", project.root)
        project.write("core/b.cpp", "int c;\n")
        self.assertEqual(before, figure_results.room_digest("core/a*", project.root))
        project.write("core/a.h", "int d;\n")
        self.assertNotEqual(before, figure_results.room_digest("core/a*", project.root))

    def test_a_group_of_rooms_stands_for_its_rooms(self):
        project = Project("part speed")
        path = os.path.join(project.root, "tools", "figures", "parts.tsv")
        project.write("tools/figures/parts.tsv", "@both\tcore rt\nspeed\t1\t@both tools/x\tcommand\tspeed\n")
        self.assertEqual(figure_results.read_parts(path)[0].rooms, ["core", "rt", "tools/x"])
        project.write("tools/figures/parts.tsv", "speed\t1\t@none\tcommand\tspeed\n")
        with self.assertRaisesRegex(figure_results.Malformed, "parts.tsv:1: @none"):
            figure_results.read_parts(path)

    def test_an_include_from_elsewhere_is_found(self):
        project = Project("part speed")
        project.write("rt/r.h", "int r;\n")
        project.write("core/a.cpp", '#include "rt/r.h"\n#include "core/a.h"\n#include <vector>\n')
        project.write("core/a.h", "int a;\n")
        found = figure_results.included_from_elsewhere(["core"], project.root)
        self.assertEqual(found, [("core/a.cpp", "rt/r.h")])

    def test_the_groups_of_the_parts_include_nothing_from_elsewhere(self):
        with open(figure_results.PARTS, encoding="utf-8") as parts:
            groups = [row.split("\t") for row in parts.read().splitlines() if row.startswith("@")]
        self.assertTrue(groups)
        for name, rooms in groups:
            self.assertEqual(figure_results.included_from_elsewhere(rooms.split()), [], name)

    def test_a_run_that_did_not_come_to_its_end_is_no_result(self):
        for text in (RESULT.replace("# whole: yes\n", ""), RESULT.replace("whole: yes", "whole: no")):
            with self.assertRaises(figure_results.Malformed):
                Project("part speed", text).run()

    def test_an_unknown_part_or_kind_is_refused(self):
        for what in ("part nothing", "parts speed"):
            with self.assertRaises(figure_results.Malformed):
                Project(what).run()

    def test_only_the_lines_that_were_picked(self):
        project = Project("pick speed:1b other:2")
        project.run(write=True)
        self.assertNotIn("a point", project.readme())
        self.assertIn("a frame at 1080p", project.readme())
        self.assertIn("(`other`) | - | not run", project.readme())


if __name__ == "__main__":
    unittest.main()

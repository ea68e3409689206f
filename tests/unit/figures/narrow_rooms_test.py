#!/usr/bin/env python3
"""tools/figures/narrow_rooms.py on a made-up repository: a part loses a room; nothing else may pass for that."""
import os
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
sys.path.insert(0, os.path.join(ROOT, "tools", "figures"))
sys.dont_write_bytecode = True
import figure_results  # noqa: E402
import narrow_rooms  # noqa: E402

RESULT = """# part: speed
# command: x
# commit: {commit}
# date: 2026-01-02
# seconds: 3
# room: core {core}
# room: rt {rt}
# whole: yes
1 ok 12 us (bar: <= 20 us) a point
"""


class NarrowRooms(unittest.TestCase):
    def setUp(self):
        """A commit with core/a.cpp, core/b.cpp, rt/r.cpp, other/o.cpp and the result of a run on it."""
        self.folder = tempfile.TemporaryDirectory()
        self.root = self.folder.name
        for name in ("core/a.cpp", "core/b.cpp", "rt/r.cpp", "other/o.cpp"):
            self.write(name, f"int {name[-5]};\n")
        self.git("init", "-q")
        self.commit()
        self.keep(rt=figure_results.room_digest("rt", self.root))

    def tearDown(self):
        self.folder.cleanup()

    def keep(self, rt):
        head = self.git("rev-parse", "HEAD").strip()
        self.write("tools/figures/results/speed.txt",
                   RESULT.format(commit=head, core=figure_results.room_digest("core", self.root), rt=rt))

    def write(self, name, text):
        path = os.path.join(self.root, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)

    def git(self, *arguments):
        return subprocess.run(["git", "-C", self.root, "-c", "user.name=n", "-c", "user.email=e@example.org", *arguments],
                              capture_output=True, text=True, check=True).stdout

    def commit(self):
        self.git("add", "core", "rt", "other")
        self.git("commit", "-qm", "state")

    def narrow(self, *rooms):
        """The part's rooms that changed since the result, after it was narrowed to these."""
        part = figure_results.Part("speed", 1.0, list(rooms), "x", "speed")
        narrow_rooms.narrow(part, self.root)
        result = figure_results.read_result("speed", os.path.join(self.root, "tools", "figures", "results"))
        self.assertEqual(list(result.rooms), list(rooms))
        self.assertEqual([line.number for line in result.lines], ["1"])
        return figure_results.changed_rooms(part, result, lambda room: figure_results.room_digest(room, self.root))

    def test_a_result_stays_valid_when_only_a_lost_file_changed(self):
        self.write("core/b.cpp", "int changed;\n")
        self.commit()
        self.assertEqual(self.narrow("core/a*", "rt"), [])

    def test_a_result_whose_remaining_room_changed_stays_old(self):
        self.write("core/a.cpp", "int changed;\n")
        self.commit()
        self.assertEqual(self.narrow("core/a*", "rt"), ["core/a*"])

    def test_a_room_with_a_file_that_was_not_measured_is_refused(self):
        with self.assertRaisesRegex(figure_results.Malformed, "other/o.cpp"):
            self.narrow("core/a*", "other")

    def test_a_result_that_is_not_of_its_commit_is_refused(self):
        self.keep(rt="0123456789abcdef")
        with self.assertRaisesRegex(figure_results.Malformed, "does not hold what the result says of rt"):
            self.narrow("core/a*")


if __name__ == "__main__":
    unittest.main()

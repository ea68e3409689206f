#!/usr/bin/env python3
"""tools/data.sh on a made-up table, folder and repository: no network."""
import hashlib
import os
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

KIT = Path(__file__).resolve().parents[3] / "tools" / "data.sh"
sys.path.insert(0, str(KIT.parent / "data"))
from convert import COMPARED, EXPORTED
from table import read_table

ROWS = [[0.0, 1.0, -2.5, 1e-6, 3.14159265, 7.0], [1.0 / 3.0, 2.0, 3.0, 4.0, 5.0, 123456.0]]
AS_CSV = ("laser1_m_s,laser2_m_s,laser3_m_s,ref_x_m_s2,ref_y_m_s2,ref_z_m_s2\n"
          "0,1,-2.5,1e-06,3.1416,7\n0.33333,2,3,4,5,1.2346e+05\n")
TABLE = """
[swing]
what = "A made-up set."
repository = "https://github.com/nobody/swing"
commit = "{commit}"
licence = "none"
known_answer = "42 Hz"
[[swing.file]]
name = "notes.txt"
sha256 = "{notes}"
upstream = "deep/a (b).txt"
upstream_sha256 = "{notes}"
[[swing.file]]
name = "setup.csv"
sha256 = "{csv}"
upstream = "deep/numbers.npy"
upstream_sha256 = "{npy}"
converter = "five_storey_npy"
[[swing.file]]
name = "frames/"
sha256 = "{frames}"
upstream = "pictures/"
upstream_sha256 = "{frames}"
[[swing.file]]
name = "by_hand.csv"
sha256 = "{hand}"
converter = "none"
"""


def sha256(data):
    return hashlib.sha256(data).hexdigest()


def npy(rows):
    header = "{'descr': '<f8', 'fortran_order': False, 'shape': (%d, %d), }" % (len(rows), len(rows[0]))
    header += " " * (-(len(header) + 11) % 64) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + struct.pack(f"<{6 * len(rows)}d", *sum(rows, []))


class DataKit(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.root = Path(self.scratch.name)
        self.source, self.to = self.root / "source", self.root / "to"
        self.write(self.source / "swing", {"notes.txt": b"notes\n", "setup.csv": AS_CSV.encode(), "frames/1.jpg": b"one", "frames/2.jpg": b"two",
                                           "by_hand.csv": b"1,2\n"})
        self.make_table("0" * 40)

    def write(self, folder, files):
        for name, data in files.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_bytes(data)

    def make_table(self, commit):
        listing = f"{sha256(b'one')}  1.jpg\n{sha256(b'two')}  2.jpg\n"
        (self.root / "table.toml").write_text(TABLE.format(commit=commit, notes=sha256(b"notes\n"), csv=sha256(AS_CSV.encode()), npy=sha256(npy(ROWS)),
                                                           frames=sha256(listing.encode()), hand=sha256(b"1,2\n")))

    def make_repository(self):
        folder = self.root / "mirror" / "nobody" / "swing"
        self.write(folder, {"deep/a (b).txt": b"notes\n", "deep/numbers.npy": npy(ROWS), "pictures/1.jpg": b"one", "pictures/2.jpg": b"two", "big": b"x" * 1000})
        git = ["git", "-C", str(folder), "-c", "user.name=nobody", "-c", "user.email=nobody@localhost"]
        for words in (["init", "-q"], ["add", "-A"], ["commit", "-q", "-m", "data"]):
            subprocess.run(git + words, check=True, capture_output=True)
        self.make_table(subprocess.run(git + ["rev-parse", "HEAD"], check=True, capture_output=True, text=True).stdout.strip())

    def run_kit(self, *words, folder=True):
        to = ["--to", str(self.to)] if folder else []
        environment = {k: v for k, v in os.environ.items() if k != "HOVERMODAL_DATA"}
        run = subprocess.run([str(KIT), "--table", str(self.root / "table.toml"), *to, *map(str, words)], capture_output=True, text=True, timeout=60,
                             env=environment)
        return run.returncode, run.stdout + run.stderr

    def test_takes_what_a_folder_has(self):
        code, text = self.run_kit("--from", self.source)
        self.assertEqual(code, 0, text)
        self.assertEqual((self.to / "swing/setup.csv").read_text(), AS_CSV)
        self.assertEqual((self.to / "swing/frames/2.jpg").read_bytes(), b"two")
        self.assertEqual(self.run_kit("--check")[0], 0)
        self.assertIn("0 of them new", self.run_kit("--from", self.source)[1])

    def test_refuses_a_wrong_sha256_and_leaves_nothing(self):
        (self.source / "swing/setup.csv").write_bytes(AS_CSV.encode() + b"\n")
        code, text = self.run_kit("--from", self.source)
        self.assertEqual(code, 1)
        for word in (str(self.source / "swing/setup.csv"), sha256(AS_CSV.encode()), sha256(AS_CSV.encode() + b"\n"), "fetch it"):
            self.assertIn(word, text)
        self.assertEqual(list(self.to.iterdir()), [])

    def test_refuses_a_folder_with_another_file_in_it(self):
        (self.source / "swing/frames/3.jpg").write_bytes(b"three")
        code, text = self.run_kit("--from", self.source)
        self.assertEqual(code, 1)
        self.assertIn("source/swing/frames: refused", text)

    def test_never_overwrites(self):
        self.write(self.to / "swing", {"notes.txt": b"mine\n"})
        code, text = self.run_kit("--from", self.source)
        self.assertEqual(code, 1)
        self.assertIn("Nothing is overwritten", text)
        self.assertEqual((self.to / "swing/notes.txt").read_bytes(), b"mine\n")

    def test_check_names_what_is_wrong_and_what_is_missing(self):
        self.run_kit("--from", self.source)
        (self.to / "swing/notes.txt").write_bytes(b"other\n")
        (self.to / "swing/by_hand.csv").unlink()
        code, text = self.run_kit("--check")
        self.assertEqual(code, 1)
        self.assertIn("notes.txt: refused", text)
        self.assertIn("by_hand.csv: not here, and in no public repository", text)

    def test_fetches_one_commit_and_converts(self):
        self.make_repository()
        code, text = self.run_kit("--mirror", self.root / "mirror")
        self.assertEqual(code, 0, text)
        self.assertEqual((self.to / "swing/setup.csv").read_text(), AS_CSV)
        self.assertEqual((self.to / "swing/notes.txt").read_bytes(), b"notes\n")
        self.assertEqual((self.to / "swing/frames/1.jpg").read_bytes(), b"one")
        self.assertIn("by_hand.csv is in no public repository", text)
        self.assertEqual([p.name for p in self.to.iterdir()], ["swing"])

    def test_a_video_of_other_bytes_is_accepted_by_its_pictures(self):
        folder = self.root / "pictures"
        folder.mkdir()
        subprocess.run(["ffmpeg", "-v", "error", "-f", "lavfi", "-i", "nullsrc=s=64x48:r=20,geq=lum='60+X+20*N':cb=128:cr=128", "-frames:v", "3", "-q:v", "2",
                        str(folder / "IMG%05d.jpg")], check=True)
        video = self.root / "video.mp4"
        EXPORTED["frame_video"](self.root, ["pictures/"], video)
        compare, limit, _ = COMPARED["frame_video"]
        self.assertLess(compare(self.root, ["pictures/"], video), limit)
        (folder / "IMG00002.jpg").write_bytes((folder / "IMG00001.jpg").read_bytes())
        (folder / "IMG00003.jpg").unlink()
        subprocess.run(["ffmpeg", "-v", "error", "-y", "-i", str(folder / "IMG00001.jpg"), "-vf", "negate", str(folder / "IMG00003.jpg")], check=True)
        self.assertGreater(compare(self.root, ["pictures/"], video), limit)
        (folder / "IMG00004.jpg").write_bytes((folder / "IMG00003.jpg").read_bytes())
        self.assertIsNone(compare(self.root, ["pictures/"], video))

    def test_refuses_an_upstream_that_changed(self):
        self.make_repository()
        table = (self.root / "table.toml").read_text()
        (self.root / "table.toml").write_text(table.replace(sha256(npy(ROWS)), "1" * 64))
        code, text = self.run_kit("--mirror", self.root / "mirror")
        self.assertEqual(code, 1)
        self.assertIn("deep/numbers.npy: sha256 differs", text)
        self.assertEqual(list(self.to.iterdir()), [])

    def test_says_what_to_do_where_it_cannot_fetch(self):
        code, text = self.run_kit("--mirror", self.root / "nowhere")
        self.assertEqual(code, 1)
        self.assertIn("--mirror names a folder", text)

    def test_lists_and_teaches(self):
        code, text = self.run_kit("--list")
        self.assertEqual(code, 0)
        for word in ("swing (not here", "https://github.com/nobody/swing", "42 Hz", "five_storey_npy"):
            self.assertIn(word, text)
        self.assertIn("--from DIR", self.run_kit("--help")[1])
        self.assertEqual(self.run_kit("swings")[0], 2)

    def test_the_projects_own_table_is_complete(self):
        sets = read_table(KIT.parent / "data" / "table.toml")
        self.assertEqual(len(sets), 14)
        for s in sets.values():
            self.assertRegex(s.commit, "^[0-9a-f]{40}$")
            self.assertTrue(s.repository.startswith("https://github.com/") and s.licence and s.answer, s.name)
            for file in s.files:
                self.assertTrue(file.converter == "none" or file.converter in EXPORTED, file.name)
                for digest in [file.sha256, *file.also, *file.upstream_sha256]:
                    self.assertRegex(digest, "^[0-9a-f]{64}$", file.name)


if __name__ == "__main__":
    unittest.main()

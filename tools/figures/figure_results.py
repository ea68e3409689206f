"""Results of the figure scripts: the parts that there are, what one run of a part left, and what changed since.

A part is one command of tools/figures with the rooms (files and folders) that its lines measure; parts.tsv lists them.
"@NAME" among the rooms is a group of rooms, which parts.tsv defines before its first use.
tools/figures/all.sh runs parts and writes results/PART.txt: a head of "# key: value" lines, then the lines as printed.
"""
import glob
import hashlib
import os
import re
import subprocess
from collections import namedtuple

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
PARTS = os.path.join(HERE, "parts.tsv")
RESULTS = os.path.join(HERE, "results")
VERDICTS = ("ok", "MISS", "SKIP", "beside")

Part = namedtuple("Part", "name minutes rooms command title")
Line = namedtuple("Line", "number verdict measured bar what")


class Malformed(ValueError):
    """A file that is not what a script writes: file, line and what is wrong."""


def read_parts(path=PARTS):
    parts, groups = [], {}
    with open(path, encoding="utf-8") as file:
        rows = file.read().splitlines()
    for n, text in enumerate(rows, 1):
        if text.startswith("#") or not text.strip():
            continue
        columns = text.split("\t")
        if columns[0].startswith("@") and len(columns) == 2:
            groups[columns[0]] = columns[1].split()
            continue
        if len(columns) != 5:
            raise Malformed(f"{path}:{n}: {len(columns)} columns, expected name, minutes, rooms, command, title")
        name, minutes, rooms, command, title = columns
        unknown = [room for room in rooms.split() if room.startswith("@") and room not in groups]
        if unknown:
            raise Malformed(f"{path}:{n}: {unknown[0]}: no such group of rooms is defined above")
        named = [one for room in rooms.split() for one in groups.get(room, [room])]
        parts.append(Part(name, float(minutes), named, command, title))
    return parts


def parse_line(text):
    """A figure's line, or None where the text is none. The bar may hold parentheses."""
    head = re.match(r"(\S+) (ok|MISS|SKIP|beside) (.*?) \(bar: ", text)
    if not head:
        return None
    depth, at = 1, head.end()
    while at < len(text) and depth:
        depth += {"(": 1, ")": -1}.get(text[at], 0)
        at += 1
    if depth:
        return None
    return Line(head[1], head[2], head[3], text[head.end() : at - 1], text[at:].strip())


class Result:
    """One run of a part. head: key -> value; lines: as printed; table: rows of a table of the script's own."""

    def __init__(self, text, source):
        self.head, self.rooms, self.lines, self.table = {}, {}, [], []
        for n, row in enumerate(text.splitlines(), 1):
            key = None if "whole" in self.head else re.match(r"# ([a-z ]+): (.*)", row)
            if key and key[1] == "room":
                room, digest = key[2].rsplit(" ", 1)
                self.rooms[room] = digest
            elif key:
                self.head[key[1]] = key[2]
            elif row.startswith("|"):
                self.table.append(row)
            elif line := parse_line(row):
                self.lines.append(line)
            elif re.match(r"\S+ (%s) " % "|".join(VERDICTS), row):
                raise Malformed(f"{source}:{n}: a figure's line without its bar: {row}")
        for key in ("part", "command", "commit", "date", "seconds", "whole"):
            if key not in self.head:
                raise Malformed(f"{source}: the head lacks '# {key}:'")
        if self.head["whole"] != "yes":
            raise Malformed(f"{source}: the run did not come to its end: it is no result")

    @property
    def commit(self):
        return self.head["commit"][:7]


def read_result(name, folder=RESULTS):
    path = os.path.join(folder, name + ".txt")
    if not os.path.exists(path):
        return None
    with open(path, encoding="utf-8") as file:
        return Result(file.read(), path)


def tracked_files(room, root=ROOT):
    """Files of a room (a file, a folder, or a pattern such as core/linear/real*), as git knows them; outside a checkout all."""
    listed = subprocess.run(["git", "-C", root, "ls-files", "-z", "--", room], capture_output=True, check=False)
    if listed.returncode == 0 and listed.stdout:
        names = listed.stdout.decode().split("\0")
    else:
        names = []
        for below in glob.glob(os.path.join(root, room)):
            found = [below] if os.path.isfile(below) else [
                os.path.join(folder, file) for folder, _, files in os.walk(below) for file in files]
            names += [os.path.relpath(name, root) for name in found]
    return sorted(n for n in names if n and os.path.isfile(os.path.join(root, n)))


def room_digest(room, root=ROOT):
    """sha256 over names and contents of a room's files in the work tree, in 16 hexadecimal digits."""
    all_files = hashlib.sha256()
    for name in tracked_files(room, root):
        with open(os.path.join(root, name), "rb") as file:
            all_files.update(f"{name}\0{hashlib.sha256(file.read()).hexdigest()}\n".encode())
    return all_files.hexdigest()[:16]


def changed_rooms(part, result, digest=room_digest):
    """Rooms of the part that are not what they were when the result was made."""
    return [room for room in part.rooms if result.rooms.get(room) != digest(room)]


def included_from_elsewhere(rooms, root=ROOT):
    """(file, header) for each header of this project that a source of the rooms includes and that no room holds."""
    files = {name for room in rooms for name in tracked_files(room, root)}
    found = []
    for name in sorted(n for n in files if n.endswith((".h", ".cpp"))):
        with open(os.path.join(root, name), encoding="utf-8") as source:
            headers = re.findall(r'^#include "([^"]+)"', source.read(), re.M)
        found += [(name, h) for h in headers if h not in files and os.path.isfile(os.path.join(root, h))]
    return found


class Digests:
    """room_digest, each room once."""

    def __init__(self, root=ROOT):
        self.root, self.known = root, {}

    def __call__(self, room):
        if room not in self.known:
            self.known[room] = room_digest(room, self.root)
        return self.known[room]

#!/usr/bin/env python3
"""Rewrites the rooms of a kept result after parts.tsv named fewer files for its part; nothing is measured again.

  tools/figures/narrow_rooms.py PART...

A part may only lose files that its figure does not read; tests/unit/figures/tables_test.py checks that the groups of
rooms still hold every header they include. The digests come from the commit that the result names, in a work tree of
its own, so that a result that was older than its rooms stays older. Refused, with exit code 2, where the commit is not
in this clone, where the rooms that the result names are not those of its commit, and where a room of parts.tsv holds a
file that no former room held. Afterwards: tools/figures/tables.py --write.
"""
import argparse
import os
import subprocess
import sys
import tempfile

import figure_results as results


def git(*arguments, root):
    done = subprocess.run(["git", "-C", root, *arguments], capture_output=True, text=True, check=False)
    if done.returncode:
        raise results.Malformed(f"git {' '.join(arguments)}: {done.stderr.strip()}")


def room_lines(part, result, then):
    """The part's room lines as they were in `then`, a work tree of the result's commit."""
    digest = results.Digests(then)
    false = [room for room, kept in result.rooms.items() if digest(room) != kept]
    if false:
        raise results.Malformed(f"{part.name}: {result.commit} does not hold what the result says of {' '.join(false)}")
    held = {name for room in result.rooms for name in results.tracked_files(room, then)}
    for room in part.rooms:
        added = [name for name in results.tracked_files(room, then) if name not in held]
        if added:
            raise results.Malformed(f"{part.name}: {room} holds {added[0]}, which no room of the result held: run it again")
    return [f"# room: {room} {digest(room)}\n" for room in part.rooms]


def narrow(part, root=results.ROOT):
    """Writes results/PART.txt with the rooms of the part as parts.tsv now names them."""
    path = os.path.join(root, "tools", "figures", "results", part.name + ".txt")
    with open(path, encoding="utf-8") as file:
        rows = file.read().splitlines(True)
    result = results.Result("".join(rows), path)
    with tempfile.TemporaryDirectory() as folder:
        then = os.path.join(folder, "then")
        git("worktree", "add", "--detach", then, result.head["commit"], root=root)
        try:
            lines = room_lines(part, result, then)
        finally:
            git("worktree", "remove", "--force", then, root=root)
    at = [n for n, row in enumerate(rows) if row.startswith("# room: ")]
    rows[at[0] : at[-1] + 1] = lines
    with open(path, "w", encoding="utf-8") as file:
        file.writelines(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("part", nargs="+", help="a part of parts.tsv that has a result")
    options = parser.parse_args()
    try:
        parts = {part.name: part for part in results.read_parts()}
        for name in options.part:
            if name not in parts:
                raise results.Malformed(f"{name}: no such part; tools/figures/tables.py --list shows them")
            narrow(parts[name])
    except (results.Malformed, OSError) as problem:
        print(f"narrow_rooms: {problem}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""The documents' tables of figures, written from tools/figures/results.

  tools/figures/tables.py --check            exit 1 where a table differs from the results (ctest figure_tables)
  tools/figures/tables.py --write            writes the tables again
  tools/figures/tables.py --list             the parts, expected minutes, state of their results
  tools/figures/tables.py --count            number of lines ok, MISS, SKIP; parts without a valid result

A table stands between `<!-- figures: ... -->` and `<!-- figures end -->` in README.md and tools/guide/figures.md:
  part NAME...       every line of these parts (a name may end in *)
  pick NAME:N ...    these lines only
  own NAME...        the table that the parts' scripts print themselves
  misses             every line that misses its bar, by part and bar, and the parts that were not run
  missed             the parts with such lines, and how many; the parts that were not run
  count              the numbers of --count
"""
import argparse
import difflib
import fnmatch
import os
import re
import sys

import figure_results as results

DOCUMENTS = ("README.md", "tools/guide/figures.md")
BLOCK = re.compile(r"(<!-- figures: (?P<what>[^>]*?) -->\n)(?P<table>.*?)(<!-- figures end -->)", re.DOTALL)
NAMED_ROOMS = 2  # in a table; --list names all
NAMED_OF_FAMILY = 2  # parts of one family, `family_...`, that are listed one by one
HEAD = "| figure | asked | measured | verdict | commit |\n| --- | --- | --- | --- | --- |\n"


class Book:
    """All parts with their results."""

    def __init__(self, root=results.ROOT):
        folder = os.path.join(root, "tools", "figures")
        self.parts = {p.name: p for p in results.read_parts(os.path.join(folder, "parts.tsv"))}
        self.digest = results.Digests(root)
        self.results = {name: results.read_result(name, os.path.join(folder, "results")) for name in self.parts}

    def matching(self, patterns):
        names = [n for pattern in patterns for n in self.parts if fnmatch.fnmatchcase(n, pattern)]
        if not names:
            raise results.Malformed(f"no part of parts.tsv matches {' '.join(patterns)}")
        return names

    def changed(self, name):
        return results.changed_rooms(self.parts[name], self.results[name], self.digest)

    def valid(self, name):
        return self.results[name] is not None and not self.changed(name)

    def commit(self, name, most=None):
        """Commit of the result and the rooms that changed since, at most this many of them by name."""
        changed = self.changed(name)
        if not changed:
            return self.results[name].commit
        named = changed[:most]
        more = f" and {len(changed) - len(named)} more" if len(named) < len(changed) else ""
        return f"{self.results[name].commit}; changed since: {' '.join(named)}{more}"

    def state(self, name):
        if self.results[name] is None:
            return "not run"
        lines = [line.verdict for line in self.results[name].lines]
        text = ", ".join(f"{lines.count(v)} {v}" for v in ("ok", "MISS", "SKIP") if v in lines)
        return f"{text} on {self.commit(name)}"


def cell(text):
    return text.replace("|", "\\|").strip() or "-"


def row(book, name, line):
    verdict = {"MISS": "**MISS**", "beside": "-"}.get(line.verdict, line.verdict)
    cells = (line.what or line.number, line.bar, line.measured, verdict, book.commit(name, NAMED_ROOMS))
    return "| " + " | ".join(map(cell, cells)) + " |\n"


def not_run(book, name):
    return f"| {cell(book.parts[name].title)} (`{name}`) | - | not run | - | - |\n"


def part_table(book, patterns):
    text = ""
    for name in book.matching(patterns):
        result = book.results[name]
        text += not_run(book, name) if result is None else "".join(row(book, name, line) for line in result.lines)
    return HEAD + text


def pick_table(book, picks):
    text = ""
    for pick in picks:
        name, number = pick.split(":")
        result = book.results[book.matching([name])[0]]
        lines = [] if result is None else [line for line in result.lines if line.number == number]
        text += "".join(row(book, name, line) for line in lines) or not_run(book, name)
    return HEAD + text


def own_table(book, patterns):
    head, rows = [], []
    for name in book.matching(patterns):
        table = [] if book.results[name] is None else book.results[name].table
        head = head or table[:2]
        rows += table[2:] or [f"| `{name}`: not run |" + " |" * 5]
    return "\n".join(head + rows) + "\n"


def by_family(book, chosen):
    """Names of parts; of a family with many of them, their number."""
    families = {}
    for name in book.parts:
        families.setdefault(name.split("_")[0], []).append(name)
    text = []
    for family, names in families.items():
        named = [name for name in names if name in chosen]
        if len(named) > NAMED_OF_FAMILY:
            text.append(f"`{family}_*` ({len(named)} of {len(names)} parts)")
        else:
            text += [f"`{name}`" for name in named]
    return ", ".join(text)


def absent(book):
    """The parts without a result, as words; empty: none."""
    names = [name for name, result in book.results.items() if result is None]
    return f"not run on the delivered program: {by_family(book, names)}" if names else ""


def missing(lines):
    """Lines that miss, those with one bar below it."""
    of_bar = {}
    for line in lines:
        of_bar.setdefault(line.bar, []).append(line)
    text = ""
    for bar, group in of_bar.items():
        text += f"  - asked: {bar}\n"
        text += "".join(f"    - {line.what or 'measured'}: {line.measured} ({line.number})\n" for line in group)
    return text


def parts_that_miss(book):
    """Name of the part, its lines that miss, the number of its lines that have a bar."""
    for name, result in book.results.items():
        judged = [line for line in (result.lines if result else []) if line.verdict != "beside"]
        lines = [line for line in judged if line.verdict == "MISS"]
        if lines:
            yield name, lines, len(judged)


def misses(book, _):
    text = ""
    for name, lines, n in parts_that_miss(book):
        head = f"`{name}`, {len(lines)} of {n} lines, on {book.commit(name, NAMED_ROOMS)}"
        text += f"- **{book.parts[name].title}** ({head})\n{missing(lines)}"
    if words := absent(book):
        text += f"- {words}\n"
    return text or "- nothing\n"


def missed(book, _):
    text = "| part | figures that miss | of | measured |\n| --- | --- | --- | --- |\n"
    for name, lines, n in parts_that_miss(book):
        state = "as it is now" if book.valid(name) else "before a change"
        text += f"| {cell(book.parts[name].title)} (`{name}`) | {len(lines)} | {n} | {state} |\n"
    if words := absent(book):
        text += f"\nAnd {words}.\n"
    return text


def count(book, _=()):
    lines = [line.verdict for result in book.results.values() if result for line in result.lines]
    valid = [name for name in book.parts if book.valid(name)]
    changed = [name for name, result in book.results.items() if result and name not in valid]
    text = f"{lines.count('ok')} figures reach their bar, {lines.count('MISS')} miss it, {lines.count('SKIP')} were skipped. "
    text += f"Of {len(book.parts)} parts {len(valid)} ran on the present state of what they measure"
    if changed:
        text += f"; what they measure changed since the run of {by_family(book, changed)}"
    if words := absent(book):
        text += f"; {words}"
    return text + ".\n"


KINDS = {"part": part_table, "pick": pick_table, "own": own_table, "misses": misses, "missed": missed, "count": count}


def written(book, text, document):
    """The document's text with every table as the results have it."""

    def table(match):
        kind, *arguments = match["what"].split()
        if kind not in KINDS:
            raise results.Malformed(f"{document}: '<!-- figures: {match['what']} -->': {kind} is none of {', '.join(KINDS)}")
        return f"{match[1]}{KINDS[kind](book, arguments)}{match[4]}"

    return BLOCK.sub(table, text)


def compare(book, root, write):
    differing = 0
    for document in DOCUMENTS:
        path = os.path.join(root, document)
        with open(path, encoding="utf-8") as file:
            before = file.read()
        after = written(book, before, document)
        if before == after:
            continue
        differing += 1
        if write:
            with open(path, "w", encoding="utf-8") as file:
                file.write(after)
            print(f"written: {document}")
        else:
            sys.stdout.writelines(difflib.unified_diff(before.splitlines(True), after.splitlines(True), document,
                                                       f"{document} as the results have it", n=0))
    if differing and not write:
        print("tables: the documents differ from tools/figures/results; tools/figures/tables.py --write writes them again")
    return 0 if write or not differing else 1


def listing(book):
    for name, part in book.parts.items():
        print(f"{name:28} {part.minutes:6g} min  {book.state(name)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--check", action="store_true")
    what.add_argument("--write", action="store_true")
    what.add_argument("--list", action="store_true")
    what.add_argument("--count", action="store_true")
    what.add_argument("--valid", metavar="PART", help="exit 0 where the part's result is of the present state")
    what.add_argument("--rooms", metavar="PART", help="a line for each room of the part with its digest")
    parser.add_argument("--root", default=results.ROOT, help="the project's folder")
    options = parser.parse_args()
    try:
        book = Book(options.root)
        if options.valid:
            return 0 if book.valid(options.valid) else 1
        if options.rooms:
            for room in book.parts[options.rooms].rooms:
                print(f"# room: {room} {book.digest(room)}")
        elif options.list:
            listing(book)
        elif options.count:
            print(count(book), end="")
        else:
            return compare(book, options.root, options.write)
    except (results.Malformed, KeyError) as problem:
        print(f"tables: {problem}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())

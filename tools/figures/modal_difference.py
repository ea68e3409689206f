#!/usr/bin/env python3
"""How far two modal.json lie apart: the number of modes of the first found in the second, and the largest relative
difference of their frequencies.
  modal_difference.py REFERENCE RESULT [--all]     --all: of every number in both files that holds no time of day, mode by mode
"""
import json
import sys

NO_RESULTS = ("utc", "version", "program", "elapsed", "path", "source", "directory")


def numbers(value, name=""):
    if any(part in name for part in NO_RESULTS):
        return
    if isinstance(value, bool) or value is None or isinstance(value, str):
        yield name, value
    elif isinstance(value, (int, float)):
        yield name, value
    elif isinstance(value, dict):
        for key in sorted(value):
            yield from numbers(value[key], f"{name}.{key}")
    else:
        for i, part in enumerate(value):
            yield from numbers(part, f"{name}.{i}")


def size(values):
    """Largest magnitude among the numbers of the same kind: a shape's small components are compared with its large ones."""
    largest = {}
    for name, value in values:
        if isinstance(value, (int, float)):
            kind = "".join(c for c in name if not c.isdigit())
            largest[kind] = max(largest.get(kind, 0.0), abs(value))
    return largest


def main():
    reference, result = (json.load(open(path)) for path in sys.argv[1:3])
    if "--all" in sys.argv:
        of, to = ({key: run[key] for key in ("modes", "rejected") if key in run} for run in (reference, result))
        first, second = list(numbers(of)), list(numbers(to))
        if [name for name, _ in first] != [name for name, _ in second]:
            sys.exit("the files hold different things")
        scale = size(first)
        worst = 0.0
        for (name, a), (_, b) in zip(first, second):
            if isinstance(a, (int, float)) and not isinstance(a, bool):
                worst = max(worst, abs(a - b) / (scale["".join(c for c in name if not c.isdigit())] or 1.0))
            elif a != b and "reason" not in name:
                sys.exit(f"{name}: {a} and {b}")
        print(len(reference["modes"]), f"{worst:.3g}")
        return
    pairs = []
    for mode in result["modes"]:
        nearest = min(reference["modes"], key=lambda m: abs(m["frequency_hz"] - mode["frequency_hz"]))
        pairs.append(abs(mode["frequency_hz"] / nearest["frequency_hz"] - 1))
    print(len(pairs), f"{max(pairs):.6g}")


main()

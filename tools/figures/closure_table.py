#!/usr/bin/env python3
"""The Markdown table of tools/guide/figures.md, from the reports that closure.sh left: closure_table.py build/figures/closure"""
import json
import pathlib
import sys

DATA = [
    ("paper", "the paper's six stated frequencies, uniform frame"),
    ("shake", "three-storey frame on a shake table, uniform frame"),
    ("published", "a published simulation against its stated truth"),
    ("knex_clock", "filmed frame, 20 fps declared, stopwatch in the picture"),
    ("knex_decay", "its free decays against one linear mode"),
    ("shake_input", "shake table under an earthquake, the ground not declared"),
    ("loggers", "four loggers that were not synchronised"),
    ("phone", "phone in a car, declared as a global shutter that does not turn"),
    ("pixels_readout", "rendered clip, readout declared wrong"),
    ("pixels_lens", "rendered clip, k1 not declared"),
    ("pixels_lost", "rendered clip, one frame in fifty lost without a trace"),
]


def short(value):
    return f"{value:.0f}" if abs(value) >= 1000 else f"{value:.3g}"


def pair(before, after, unit):
    if before is None or after is None:
        return "-"
    return f"{short(before)} to {short(after)} {unit}"


def parameter(name, p):
    sigma = f" +- {p['sigma']:.2g}" if p["sigma"] is not None else ""
    unit = "" if p["unit"] in ("1", "") else " " + p["unit"]
    return f"{name} {p['value']:.4g}{sigma}{unit}"


def effect(step):
    words = step["effect"].replace("_", " ")
    parameters = list(step["parameters"].items())
    if 0 < len(parameters) <= 2:
        words += " (" + ", ".join(parameter(*p) for p in parameters) + ")"
    if step["rivals"]:
        words += ", or " + ", ".join(r.replace("_", " ") for r in step["rivals"])
    return words


def not_from_zero(c):
    """Effects that the data do not tell from zero: said, not adopted."""
    return [r["effect"].replace("_", " ") + " " + r["reason"] for r in c.get("refused", [])
            if "cannot be distinguished from zero" in r["reason"]]


def modes(c):
    found = [(len([m for m in c[k] if m["reference_hz"] is not None and m["frequency_hz"] > 0])) for k in ("modes_before", "modes_after")]
    false = [(len([m for m in c[k] if m["reference_hz"] is None])) for k in ("modes_before", "modes_after")]
    text = f"{found[0]} to {found[1]}" if any(found) else "-"
    return text + (f", false ones {false[0]} to {false[1]}" if any(found) and any(false) else "")


def main():
    folder = pathlib.Path(sys.argv[1])
    print("| data | residual before | traced to | held-out error | error against the reference | modes found |")
    print("| --- | --- | --- | --- | --- | --- |")
    for name, words in DATA:
        path = folder / name / "closure.json"
        if not path.exists():
            continue
        c = json.loads(path.read_text())
        unit, steps = c["baseline"]["unit"], c["steps"]
        held = pair(steps[0]["heldout_before"], steps[-1]["heldout_after"], unit) if steps else "-"
        print("|", " | ".join([
            words, f"{short(c['baseline']['residual_rms'])} {unit}", "; ".join([effect(s) for s in steps] + not_from_zero(c)) or "nothing", held,
            pair(c["reference_error_before"], c["reference_error_after"], c["reference_unit"]), modes(c)]), "|")


if __name__ == "__main__":
    main()

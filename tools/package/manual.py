#!/usr/bin/env python3
"""Manual pages from what the programs themselves say (--help, --help-config): one source, and nothing to keep in step.

  manual.py OUT_DIR VERSION DATE HOVERMODALD HOVERMODAL [PREFIX...]   PREFIX: an emulator, where the programs need one
"""
import os
import re
import subprocess
import sys

OPTION = re.compile(r"^  (-\S.*?)(?:\s{2,}(.*))?$")
MEANING_COLUMN = 30  # where CLI11 begins what an option means; one blank before it is enough
SUBCOMMAND = re.compile(r"^  ([a-z][a-z0-9-]*)(?:\s{2,}(.*))?$")


def text(line):
    """A line of the page: what troff would take for a command is escaped."""
    line = line.replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq").replace("`", "\\(ga").replace("^", "\\(ha").replace("~", "\\(ti")
    return "\\&" + line if line[:1] in ".'" else line


def paragraphs(lines):
    """Plain lines run on; indented ones are shown as they stand."""
    out, shown = [], False
    for line in lines:
        if shown != line.startswith("  ") and line.strip():
            shown = not shown
            out += [".PP", ".nf", ".RS"] if shown else [".RE", ".fi", ".PP"]
        if line.strip():
            out.append(text(line[2:] if shown else line))
            # Sentences of a help text begin on lines of their own: keep them so.
            if not shown:
                out.append(".br")
        elif not shown:
            out.append(".PP")
    if shown:
        out += [".RE", ".fi"]
    return tidy(out)


def tidy(out):
    """No paragraph mark or break that has nothing after it: groff warns of those."""
    kept = []
    for line in out:
        if line == ".PP" and kept and kept[-1] in (".PP", ".br"):
            kept.pop()
        if line in (".PP", ".br") and (not kept or kept[-1] in (".PP", ".fi") and line == ".br"):
            continue
        kept.append(line)
    while kept and kept[-1] in (".PP", ".br"):
        kept.pop()
    return kept


class Help:
    """The help of one program or subcommand, taken apart: description, options, subcommands, and what follows."""

    def __init__(self, command):
        run = subprocess.run(command + ["--help"], capture_output=True, text=True)
        if run.returncode:
            sys.exit(f"manual: {' '.join(command)} --help ended with {run.returncode}: {run.stderr.strip()}")
        lines = run.stdout.splitlines()
        usage = next(i for i, line in enumerate(lines) if line.startswith("Usage:"))
        self.about = lines[:usage]
        self.usage = re.sub(r"^Usage: \S+/", "", lines[usage])
        self.options, self.subcommands, self.after = [], [], []
        part = self.after
        rest = lines[usage + 1:]
        for line, following in zip(rest, rest[1:] + [""], strict=True):
            if line == "Options:":
                part = self.options
            elif line == "Subcommands:":
                part = self.subcommands
            elif re.match(r"^[A-Z][a-z ]*:$", line) and any(OPTION.match(l) for l in rest[rest.index(line) + 1:][:2]):
                part = self.options
                part.append([line, []])
            elif part is self.after:
                part.append(line)
            elif part is self.options and line[MEANING_COLUMN - 2:MEANING_COLUMN].strip() and line[MEANING_COLUMN - 1:MEANING_COLUMN] == " " and not following.startswith(" " * MEANING_COLUMN):
                part.append([line[:MEANING_COLUMN].strip(), [line[MEANING_COLUMN:]]])
            elif (match := (OPTION if part is self.options else SUBCOMMAND).match(line)):
                part.append([match[1], [match[2]] if match[2] else []])
            elif line.startswith("    ") and part:
                part[-1][1].append(line.strip())
            elif line.strip():
                part = self.after
                part.append(line)

    def options_page(self):
        out = []
        for name, meaning in self.options:
            if not name.startswith("-"):
                out += [".PP", text(name)]
                continue
            out += [".TP", ".B " + text(name)] + [text(line) for line in meaning]
        return out


def page(name, section, title, version, date, parts):
    out = [f'.TH {name.upper()} {section} {date} "hovermodal {version}" "hovermodal"', ".SH NAME", f"{name} \\- {title}"]
    for heading, lines in parts:
        if lines:
            out += [f".SH {heading}"] + lines
    return "\n".join(out) + "\n"


def files(*pairs):
    return [part for path, meaning in pairs for part in (".TP", f".I {path}", meaning)]



def service_page(program, version, date):
    told = Help(program)
    about = [line for line in told.about if not line.startswith("Exit codes")]
    codes = re.findall(r"(\d) ([^,.]+)", next((line for line in told.about if line.startswith("Exit codes")), ""))
    exits = [part for code, meaning in codes for part in (".TP", f".B {code}", meaning)]
    return page("hovermodald", 8, "modes of vibration of a structure, while a camera hovers", version, date, [
        ("SYNOPSIS", [".B hovermodald", "\\-\\-config FILE [OPTION]..."]), ("DESCRIPTION", paragraphs(about)),
        ("OPTIONS", told.options_page()), ("EXIT STATUS", exits),
        ("FILES", files(("/etc/hovermodal/hovermodald.yaml", "Configuration of the service."),
                        ("/var/lib/hovermodal", "What the service writes: reports, records, its state. Relative paths begin here."))),
        ("SEE ALSO", [".BR hovermodald.yaml (5),", ".BR hovermodal (1),", ".BR journalctl (1)"])])


def tool_page(program, version, date):
    told = Help(program)
    commands = []

    def describe(names):
        sub = Help(program + names)
        out = [f".SS hovermodal {' '.join(names)}"] + paragraphs(sub.about) + sub.options_page()
        if sub.after and any(line.strip() for line in sub.after):
            out += [".PP"] + paragraphs(sub.after)
        commands.extend(out)
        for name, _ in sub.subcommands:
            describe(names + [name])

    for name, _ in told.subcommands:
        describe([name])
    return page("hovermodal", 1, "companion of the service hovermodald, at the desk and on the ground", version, date, [
        ("SYNOPSIS", [".B hovermodal", "COMMAND [OPTION]..."]), ("DESCRIPTION", paragraphs(told.about)), ("OPTIONS", told.options_page()),
        ("COMMANDS", commands), ("EXIT STATUS", ["0 done, 1 it failed, 2 usage or a file that cannot be read as one."]),
        ("SEE ALSO", [".BR hovermodald (8),", ".BR hovermodald.yaml (5)"])])


def configuration_page(program, version, date):
    run = subprocess.run(program + ["--help-config"], capture_output=True, text=True, check=True)
    head, keys = run.stdout.split("EVERY KEY\n")
    out = []
    for line in keys.splitlines():
        if (match := re.match(r"^(\S+)\s+(.*)$", line)):
            out += [".TP", f".BR {text(match[1])} \" ({text(match[2])})\""]
        elif line.strip():
            default = line.strip().startswith("default:")
            out += ([".br"] if default else []) + [text(line.strip())]
    intro = [line[2:] if line.startswith("    ") else line for line in head.splitlines()[1:]]
    return page("hovermodald.yaml", 5, "configuration of the service hovermodald", version, date, [
        ("DESCRIPTION", paragraphs(intro)), ("KEYS", out),
        ("FILES", files(("/etc/hovermodal/hovermodald.yaml", "The service's own."))),
        ("SEE ALSO", [".BR hovermodald (8)"])])


def main():
    if len(sys.argv) < 6:
        sys.exit(__doc__)
    out_dir, version, date, service, tool, *emulator = sys.argv[1:]
    os.makedirs(out_dir, exist_ok=True)
    for name, made in (("hovermodald.8", service_page(emulator + [service], version, date)),
                       ("hovermodal.1", tool_page(emulator + [tool], version, date)),
                       ("hovermodald.yaml.5", configuration_page(emulator + [service], version, date))):
        with open(os.path.join(out_dir, name), "w", encoding="utf-8") as file:
            file.write(made)


main()

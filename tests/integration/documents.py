#!/usr/bin/env python3
"""Runs every command of the documents, in order, in a folder of its own and a network of its own, and looks up every option and
key that they name: documents.py BIN SOURCES SCRATCH [DOCUMENT...]. Ends with 1 and a line for each thing that does not hold.

An indented block of a document is either YAML, whose keys must be known, or commands. An HTML comment in front of it says more:
  <!-- file: NAME -->          the block is the content of that file, for the commands that follow
  <!-- until stopped -->       each command runs until it is interrupted, and must end by that then
  <!-- run by SCRIPT -->       needs a device, a machine of its own or much time: SCRIPT runs it, and must hold the program, its
                               subcommand and its options
"""
import math
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

DOCUMENTS = ["README.md", "tools/guide/engineer.md", "tools/guide/integrator.md", "tools/guide/structures.md"]
SECTIONS = "camera calibration regions scale tracking spectrum identification closure telemetry report record state rt".split()
PATIENCE_S = 900
faults = []


def fault(where, what):
    faults.append(f"{where}: {what}")
    print(f"{where}: {what}", flush=True)


class Block:
    def __init__(self, document, line, remark):
        self.where, self.remark, self.lines = f"{document}:{line}", remark, []

    @property
    def is_yaml(self):
        return re.match(r"([a-z_]+|- [{a-z_]+.*):( |$)", self.lines[0]) is not None


def read(path, document):
    """Blocks in order, and the prose with its line numbers."""
    blocks, prose, block, remark = [], [], None, ""
    for number, line in enumerate(path.read_text().splitlines(), 1):
        comment = re.fullmatch(r"\s*<!-- (.*) -->", line)
        indent = re.match(r" {4,}\S", line)
        if indent and (block or not prose or not prose[-1][1].strip() or remark):
            if block is None:
                block = Block(document, number, remark)
                blocks.append(block)
            block.lines.append(line)
            remark = ""
            continue
        if line.strip():
            block = None
            remark = comment.group(1) if comment else ""
        prose.append((number, "" if comment else line))
    for block in blocks:
        margin = min(len(l) - len(l.lstrip()) for l in block.lines)
        block.lines = [l[margin:] for l in block.lines]
    return blocks, prose


class Programs:
    """What our programs say of themselves."""

    def __init__(self, bin_folder):
        self.bin, self.known = bin_folder, {}

    def help(self, *words):
        if words not in self.known:
            run = subprocess.run([self.bin / words[0], *words[1:]], capture_output=True, text=True, timeout=60)
            self.known[words] = run.stdout if run.returncode == 0 else ""
        return self.known[words]

    def subcommands(self):
        text = self.help("hovermodal", "--help")
        return re.findall(r"(?m)^  ([a-z]+) ", text[text.index("Subcommands:"):])

    def all_help(self):
        nested = [("inspect", "cameras"), ("inspect", "telemetry"), ("inspect", "lcm")]
        commands = [(name,) for name in self.subcommands()] + nested
        return "".join(self.help("hovermodal", *names, "--help") for names in commands) + self.help("hovermodald", "--help")

    def keys(self):
        """section.key of every key of the configuration, and the sections."""
        text = self.help("hovermodald", "--help-config")
        out = set()
        for section, key in re.findall(r"(?m)^([a-z_]+)(?:\[\])?(?:\.([a-z_.]+))?  +", text[text.index("EVERY KEY"):]):
            out |= {section, f"{section}.{key}"}
        return out


def simple_commands(line):
    """The programs of one line with their arguments; comments and redirections left out."""
    words = shlex.split(line, comments=True)
    command, out = [], []
    for word in words:
        if word in ("&&", "|", ";"):
            out, command = out + [command], []
        else:
            command.append(word)
    return [c for c in out + [command] if c]


def check_run_elsewhere(block, sources, programs):
    script = sources / block.remark.removeprefix("run by ")
    if not script.is_file():
        return fault(block.where, f"{script.relative_to(sources)} is not there")
    text = script.read_text()
    for line in block.lines:
        for command in simple_commands(line):
            name = Path(command[0]).name
            essentials = [name] + [w.split("=")[0] for w in command[1:] if w.startswith("--")]
            if name == "hovermodal":
                essentials.append(command[1])
                known = programs.help("hovermodal", command[1], "--help")
                for option in (w for w in essentials if w.startswith("--") and w not in known):
                    fault(block.where, f"`{line}`: hovermodal {command[1]} has no {option}")
            for word in essentials:
                if word not in text:
                    fault(block.where, f"`{line}`: {script.relative_to(sources)} does not hold `{word}`")


def run(block, line, environment, folder):
    began = time.monotonic()
    stopped = block.remark == "until stopped"
    child = subprocess.Popen(["bash", "-c", "set -o pipefail; " + line], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True)
    try:
        text, _ = child.communicate(timeout=4 if stopped else PATIENCE_S)
        if stopped:
            fault(block.where, f"`{line}` ended by itself:\n{text[-2000:]}")
    except subprocess.TimeoutExpired:
        os.killpg(child.pid, signal.SIGINT if stopped else signal.SIGKILL)
        try:
            text, _ = child.communicate(timeout=60)
        except subprocess.TimeoutExpired:
            os.killpg(child.pid, signal.SIGKILL)
            return fault(block.where, f"`{line}` does not end when it is interrupted")
        if not stopped:
            return fault(block.where, f"`{line}` did not end in {PATIENCE_S} s")
    ended = (0, -signal.SIGINT, 128 + signal.SIGINT) if stopped else (0,)
    if child.returncode not in ended:
        fault(block.where, f"`{line}` ended with {child.returncode}:\n{text[-2000:]}")
    print(f"  {time.monotonic() - began:5.1f} s  {line}", flush=True)


def check_yaml(block, keys):
    path = []
    for line in block.lines:
        line = line.split(" #")[0]
        indent = len(line) - len(line.lstrip(" "))
        while path and path[-1][0] >= indent:
            path.pop()
        bare = line.strip().removeprefix("- ")
        section = path[0][1] if path else ""
        if m := re.match(r"([a-z_]+):", bare):
            if not path:
                section = m.group(1)
            if (section if not path else f"{section}.{m.group(1)}") not in keys:
                fault(block.where, f"`{line.strip()}`: there is no such key")
            path.append((indent, m.group(1)))
        for key in re.findall(r"[{,] *([a-z_]+):", bare):
            if f"{section}.{key}" not in keys:
                fault(block.where, f"`{line.strip()}`: there is no key {section}.{key}")


def check_words(document, prose, programs, keys, sources):
    options = programs.all_help() + "".join(p.read_text() for p in sorted(sources.glob("tools/*.sh")) + [sources / "tests/device/run.sh"])
    for number, line in prose:
        for code in re.findall(r"`([^`]+)`", line):
            ours = re.match(r"--|hovermodal|tools/", code)
            for option in re.findall(r"(?<![\w-])--[a-z][a-z-]+", code) if ours else []:
                if not re.search(re.escape(option) + r"(?![a-z-])", options):
                    fault(f"{document}:{number}", f"`{code}`: no program has {option}")
            m = re.fullmatch(r"(" + "|".join(SECTIONS) + r")\.([a-z_]+)(: .*|=.*)?", code)
            if m and f"{m.group(1)}.{m.group(2)}" not in keys and not code.endswith((".csv", ".md", ".yaml", ".json", ".html")):
                fault(f"{document}:{number}", f"`{code}`: there is no such key")


def make_board(folder, environment):
    """A chessboard of 9 x 6 inner corners, squares of 25 mm, before a camera of 900 px focal length, from 24 sides."""
    wide, high, square = 1280, 720, 72
    pixel = lambda u, v: 255 * ((u - 280) // square % 2 == (v - 108) // square % 2) if 280 <= u < 1000 and 108 <= v < 612 else 255
    views = folder / "board"
    views.mkdir()
    (views / "flat.pgm").write_bytes(b"P5 %d %d 255\n" % (wide, high) + bytes(pixel(u, v) for v in range(high) for u in range(wide)))
    for k in range(24):
        yaw, pitch = 0.6 * math.sin(1.7 * k), 0.5 * math.cos(2.3 * k)
        shift, up, away = 60 * math.sin(0.9 * k), 35 * math.cos(1.3 * k), 430 + 60 * math.sin(k)
        corners = []
        for u, v in ((0, 0), (wide, 0), (0, high), (wide, high)):
            x, y = (u - wide / 2) * 25 / square, (v - high / 2) * 25 / square
            x, z = x * math.cos(yaw), x * math.sin(yaw)
            y, z = y * math.cos(pitch) - z * math.sin(pitch), y * math.sin(pitch) + z * math.cos(pitch) + away
            corners += [900 * (x + shift) / z + wide / 2, 900 * (y + up) / z + high / 2]
        places = ":".join(f"{'xy'[i % 2]}{i // 2}={corner:.3f}" for i, corner in enumerate(corners))
        subprocess.run(["ffmpeg", "-loglevel", "error", "-y", "-i", views / "flat.pgm", "-vf", f"perspective={places}:sense=destination:interpolation=cubic",
                        views / f"{k:02}.png"], check=True, env=environment)
    subprocess.run(["ffmpeg", "-loglevel", "error", "-y", "-framerate", "2", "-i", views / "%02d.png", "-r", "10", "-pix_fmt", "yuv420p", "-crf", "10",
                    folder / "board.mp4"], check=True, env=environment)


def make_fixtures(bin_folder, sources, folder, environment):
    """What a reader has at hand: a clip, a filmed chessboard, attitudes."""
    made = folder / "fixture"
    subprocess.run([bin_folder / "hovermodal", "simulate", "--preset", "paper", "--duration", "24", "--out", made], check=True,
                   env=environment, stdout=subprocess.DEVNULL)
    shutil.copy(made / "clip.mp4", folder / "flight.mp4")
    make_board(folder, environment)
    rows = "".join(f"{k / 50:.2f},{0.02 * (k % 7 - 3):.3f},0,0\n" for k in range(24 * 50 + 50))
    for name, place in (("build/release/bin", bin_folder), ("tools", sources / "tools")):  # as seen from the top of the sources
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).symlink_to(place)
    (folder / "attitude.csv").write_text("t_s,roll_deg,pitch_deg,yaw_deg\n" + rows)


def go(bin_folder, sources, scratch, documents):
    shutil.rmtree(scratch, ignore_errors=True)
    scratch.mkdir(parents=True)
    environment = dict(os.environ, PATH=f"{bin_folder}:{os.environ['PATH']}", PYTHONDONTWRITEBYTECODE="1")
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background job ignores it, and so would all it starts
    programs = Programs(bin_folder)
    keys = programs.keys()
    make_fixtures(bin_folder, sources, scratch, environment)
    n_run = n_elsewhere = 0
    for document in documents:
        print(document, flush=True)
        blocks, prose = read(sources / document, document)
        check_words(document, prose, programs, keys, sources)
        for block in blocks:
            if block.remark.startswith("file: "):
                (scratch / block.remark.removeprefix("file: ")).write_text("\n".join(block.lines) + "\n")
            elif block.remark.startswith("run by "):
                check_run_elsewhere(block, sources, programs)
                n_elsewhere += len(block.lines)
            elif block.is_yaml:
                check_yaml(block, keys)
            else:
                for line in block.lines:
                    run(block, line, environment, scratch)
                    n_run += 1
    print(f"{n_run} commands run, {n_elsewhere} run by figures, {len(faults)} faults")
    return 1 if faults else 0


def main():
    bin_folder, sources, scratch = (Path(p).resolve() for p in sys.argv[1:4])
    if "HOVERMODAL_DOCUMENTS_INSIDE" not in os.environ:  # a network that holds a loopback device, and nothing else
        own = ["unshare", "-rn"]
        if subprocess.run(own + ["true"], capture_output=True).returncode != 0:
            print("SKIP: no network of its own can be made here (unshare -rn)")
            return 77
        environment = dict(os.environ, HOVERMODAL_DOCUMENTS_INSIDE="1")
        return subprocess.run(own + ["bash", "-c", 'ip link set lo up && exec "$@"', "-", sys.executable] + sys.argv, env=environment).returncode
    return go(bin_folder, sources, scratch, sys.argv[4:] or DOCUMENTS)


sys.exit(main())

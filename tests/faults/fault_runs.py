#!/usr/bin/env python3
"""Runs hovermodald and hovermodal again and again, in each run one call to a file function or the allocator fails (fault_calls.cpp), and looks for crashes
and silent losses.
    fault_runs.py BIN LIBRARY FOLDER [--kinds KIND,...] [--programs service,replay] [--every K] [--first N] [--jobs J]
Every n-th call is made to fail, n = N, N + K, ...; a run is 4 s of a simulated clip with report, record and state, over the
report of an earlier run. A crash is a signal or a run without an end (120 s). A silent loss is
  - exit code 0, and a file of the report or a frame of the record that differs from those of an undisturbed run (or a
    state that should be gone) without one warning or error that the undisturbed run does not print,
  - exit code 0 without a complete report, or "open PAGE" where there is none,
  - another exit code without an error in words,
  - an earlier report of which a byte is lost: neither in place nor in report.1, nor after the next run.
Prints "program<TAB>kind<TAB>runs<TAB>reached<TAB>crashes<TAB>silent<TAB>told", then each finding, which stands in FOLDER/findings.txt, too.
Exit code 1 where there is one."""
import argparse
import hashlib
import json
import os
import re
import shutil
import struct
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools" / "figures"))
import lcm_log  # noqa: E402

KINDS = ("enospc", "enospc_once", "eio", "eio_once", "eintr", "short", "emfile", "enomem", "slow", "erofs")
LONGEST_S = 120
COUNT = struct.Struct("<QQqQ")


def digests(folder):
    return {p.name: hashlib.sha256(p.read_bytes()).hexdigest() for p in sorted(folder.glob("*")) if p.is_file()}


def recorded_frames(folder):
    """Payloads of the frames in a record, without times of the wall clock."""
    frames = []
    for path in sorted(folder.glob("*.lcm")):
        try:
            for _, _, channel, data in lcm_log.events(path):
                if channel.endswith("RUN_FRAME"):
                    frames.append(hashlib.sha256(data).hexdigest())
        except ValueError:  # damaged from here on
            pass
    return frames


def words(log):
    """Warnings, errors and remarks on what is missing, without their times."""
    remark = r"\[[^]]*\] \[(warning|error)\]|hovermodal: |.*\b(damaged|left out|cut off|predicted)\b"
    return {re.sub(r"^\[[^]]*\] ", "", line) for line in log.splitlines() if re.match(remark, line)}


class Program:
    """A command with its inputs, and what an undisturbed run of it leaves."""

    def __init__(self, binaries, folder, clip):
        self.binaries, self.folder, self.clip = binaries, folder, clip

    def prepare(self, place):
        shutil.copytree(self.folder / "old", place / "report")

    def run(self, place, environment=None):
        full = {**os.environ, **(environment or {})}
        try:
            done = subprocess.run([str(a) for a in self.command(place)], env=full, cwd=place, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, timeout=LONGEST_S, check=False)
            return done.returncode, done.stdout.decode(errors="replace")
        except subprocess.TimeoutExpired:
            return None, "no end"

    def reference(self):
        self.known, self.codes = set(), set()
        for k in range(3):
            place = self.folder / f"reference_{self.name}_{k}"
            place.mkdir(parents=True)
            self.prepare(place)
            code, log = self.run(place)
            if code != 0:
                sys.exit(f"{self.name}: an undisturbed run ends with {code}: {log[-500:]}")
            self.known |= words(log)
            self.files, self.frames = digests(place / "report"), recorded_frames(place / "record")
        self.old = digests(self.folder / "old")

    def losses(self, place, code, log):
        """What a run has lost without a word."""
        told = words(log) - self.known
        if code != 0:
            if not told:
                yield f"exit code {code} without a word"
        else:
            new = digests(place / "report")
            missing = sorted(set(self.files) - set(new))
            if "modal.json" in missing or new.get("modal.json") == self.old["modal.json"]:
                yield "exit code 0 without a report"
            # The page states the computer's load, too.
            differing = missing + sorted(n for n in self.files if n in new and new[n] != self.files[n] and n != "report.html")
            if (place / "report" / "report.html").exists() and not (place / "report" / "report.html").read_text().endswith("</html>\n"):
                yield "report.html is cut off"
            if differing and not told:
                yield f"{', '.join(differing)}: missing or different, exit code 0, not a word"
            if recorded_frames(place / "record") != self.frames and not told:
                yield "the record differs, exit code 0, not a word"
            if any((place / "state").glob("*")) and not told:
                yield "a state is left, exit code 0, not a word"
            page = re.search(r"open (\S+report\.html)", log)
            if page and not (place / page.group(1)).exists():
                yield "names a page that does not exist"
        if not self.has_old(place):
            self.run(place)  # a hand-over that was interrupted is completed by the next run
            if not self.has_old(place):
                yield f"exit code {code}: a byte of the earlier report is lost"

    def has_old(self, place):
        return any(d.is_dir() and self.old.items() <= digests(d).items()
                   for d in [place / "report", *sorted((place / "report").glob("report.*"))])


class Service(Program):
    name = "service"

    def command(self, place):
        keys = {"telemetry.lcm_url": "", "closure.adopt": "off", "spectrum.segment": 32, "report.directory": "report",
                "record.directory": "record", "state.directory": "state", "state.period_s": 1}
        return [self.binaries / "hovermodald", "--config", self.clip / "config.yaml",
                *(a for k, v in keys.items() for a in ("--set", f"{k}={v}"))]


class Replay(Program):
    name = "replay"

    def command(self, _):
        return [self.binaries / "hovermodal", "replay", *sorted((self.folder / "reference_service_0" / "record").glob("*.lcm")),
                "--report", "report"]


class Hunt:
    def __init__(self, options):
        self.options, self.folder = options, options.folder
        self.findings = open(options.folder / "findings.txt", "w", encoding="utf-8")

    def environment(self, kind, n, count):
        return {"HOVERMODAL_FAULT": f"{kind}:{n}", "HOVERMODAL_FAULT_COUNT": str(count), "LD_PRELOAD": str(self.options.library),
                "LCM_DEFAULT_URL": "memq://"}

    def one(self, program, kind, n):
        place = self.folder / f"run_{program.name}_{kind}_{n}"
        place.mkdir()
        program.prepare(place)
        count = place / "count"
        code, log = program.run(place, self.environment(kind, n, count))
        data = count.read_bytes()
        n_calls, n_failed, call, address = COUNT.unpack_from(data)
        what = data[COUNT.size:].split(b"\0")[0].decode(errors="replace")
        found = {"n_calls": n_calls, "n_failed": n_failed, "crash": code is None or code < 0 or code >= 128, "losses": [],
                 "told": bool(words(log) - program.known), "where": f"call {call} {what}" + (f" +0x{address:x}" if address else "")}
        if n > 0 and not found["crash"]:
            found["losses"] = list(program.losses(place, code, log))
        if found["crash"] or found["losses"]:
            said = "; ".join([f"ended with {code}"] * found["crash"] + found["losses"])
            self.findings.write(f"{program.name} {kind}:{n} ({found['where']}): {said}\n")
            self.findings.flush()
            (self.folder / f"log_{program.name}_{kind}_{n}.txt").write_text(log, encoding="utf-8")
        shutil.rmtree(place)
        return found

    def hunt(self, program, kind):
        # Threads change the number of calls from run to run: the largest of three.
        n_calls = max(self.one(program, kind, 0)["n_calls"] for _ in range(3))
        numbers = range(self.options.first, n_calls + 1, self.options.every)
        with ThreadPoolExecutor(self.options.jobs) as pool:
            found = list(pool.map(lambda n: self.one(program, kind, n), numbers))
        n_bad = [sum(f["crash"] for f in found), sum(bool(f["losses"]) for f in found)]
        print(program.name, kind, len(found), sum(f["n_failed"] > 0 for f in found), *n_bad, sum(f["told"] for f in found), sep="\t",
              flush=True)
        return sum(n_bad)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("binaries", "library", "folder"):
        parser.add_argument(name, type=lambda p: Path(p).resolve())
    parser.add_argument("--kinds", default=",".join(KINDS))
    parser.add_argument("--programs", default="service,replay")
    for name, default in (("every", 1), ("first", 1), ("jobs", 1), ("seed", 3)):
        parser.add_argument(f"--{name}", type=int, default=default)
    options = parser.parse_args()
    shutil.rmtree(options.folder, ignore_errors=True)
    options.folder.mkdir(parents=True)
    clip, scene = options.folder / "clip", options.folder / "scene.yaml"
    scene.write_text(f"preset: paper\nduration_s: 4\nseed: {options.seed}\n", encoding="utf-8")
    subprocess.run([options.binaries / "hovermodal", "simulate", "--scene", scene, "--size", "480x270", "--out", clip], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    (options.folder / "old").mkdir()
    (options.folder / "old" / "modal.json").write_text(json.dumps({"modes": [{"frequency_hz": 1.0}]}), encoding="utf-8")
    (options.folder / "old" / "tracks.csv").write_text("# of an earlier run\n" * 1000, encoding="utf-8")
    programs = [c(options.binaries, options.folder, clip) for c in (Service, Replay)]
    for program in programs:
        program.reference()
    hunt = Hunt(options)
    n_bad = sum(hunt.hunt(p, k) for p in programs if p.name in options.programs.split(",") for k in options.kinds.split(","))
    print((options.folder / "findings.txt").read_text(encoding="utf-8"), end="")
    sys.exit(1 if n_bad else 0)


if __name__ == "__main__":
    main()

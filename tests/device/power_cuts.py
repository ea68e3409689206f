#!/usr/bin/env python3
"""Cuts the power of a computer on which hovermodald writes report, record and state, and starts the service on what is left.
    power_cuts.py BIN FOLDER CUTS FIRST_SEED
The runs are those of tests/device/cases/power.sh in a virtual machine. QEMU keeps every write to its disk, in order, and every
order to empty the disk's cache (in the form of the kernel's dm-log-writes). Cut k ends this log at a write drawn from seed
FIRST_SEED + k: what came before the last emptied cache is on the disk; of what came after it each write is there or not, with
a probability drawn for the cut, as a disk may write its cache in any order; the last write may be cut at any sector. The file
system is then recovered from its journal, the service is started on it, and its words, the report, the state and the records
are compared with those of the runs that came to their end. A record that was cut may end in less than a block of zeros: ext4
keeps the new length of a block that it has already, before its bytes. FOLDER: is emptied. Prints a line "cut<TAB>..." for each cut, then
"name<TAB>value" lines; exit code 1 where something is unreadable or lost, 77 where there is no virtual machine."""
import os
import random
import re
import shutil
import signal
import struct
import subprocess
import sys
from pathlib import Path

RUNS, DISK_BYTES, SECTOR, BLOCK = 4, 512 << 20, 512, 4096
FLUSH, FUA, DISCARD = 1, 2, 4
KEYS = ["camera.pace=realtime", "tracking.min_distance_px=3", "tracking.points_per_region=10", "spectrum.segment=128", "state.period_s=2", "telemetry.lcm_url=", "closure.adopt=off",
        "rt.thin_overload=false", "rt.frame_slots=160", "rt.sample_slots=256"]
ROOT = Path(__file__).resolve().parents[2]


class Log:
    """The writes that reached the disk: (byte of the disk, bytes, flags, byte of the log) each."""

    def __init__(self, path):
        self.file = open(path, "rb")
        size = path.stat().st_size
        magic, version, n, sector = struct.unpack("<QQQI", self.file.read(28))
        if magic != 0x6A736677736872 or version != 1 or sector != SECTOR:
            sys.exit(f"{path}: no log of writes")
        self.entries, self.ends, at = [], [], SECTOR
        while len(self.entries) < n and at + SECTOR <= size:
            self.file.seek(at)
            where, n_sectors, flags, _ = struct.unpack("<QQQQ", self.file.read(32))
            n_bytes = n_sectors * SECTOR
            self.entries.append((where * SECTOR, n_bytes, flags, at + SECTOR))
            at += SECTOR + (0 if flags & DISCARD else n_bytes)
            self.ends.append(at)

    def index(self, log_bytes):
        """How many entries were in the log when it had this length."""
        return sum(end <= log_bytes for end in self.ends)

    def cut(self, base, image, last, draw):
        """The disk after a cut at entry `last`; returns how many writes of its cache it lost."""
        shutil.copyfile(base, image)
        emptied = max((i for i in range(last + 1) if self.entries[i][2] & FLUSH), default=0)
        kept = draw.random()
        n_lost = 0
        with open(image, "r+b") as disk:
            for i, (where, n_bytes, flags, at) in enumerate(self.entries[:last + 1]):
                if n_bytes == 0 or flags & DISCARD:
                    continue
                if i > emptied and not flags & FUA and draw.random() > kept:
                    n_lost += 1
                    continue
                if i == last and i > emptied:
                    n_bytes = draw.randrange(n_bytes // SECTOR + 1) * SECTOR
                self.file.seek(at)
                disk.seek(where)
                disk.write(self.file.read(n_bytes))
        return n_lost


def files_in(folder):
    return {p.name: p.read_bytes() for p in Path(folder).iterdir() if p.is_file()} if Path(folder).is_dir() else {}


class Flight:
    """The runs in the virtual machine, what they left, and what they said a loss of power must leave."""

    def __init__(self, binaries, folder, seed):
        self.binaries, self.out = binaries, folder / "out"
        self.config = folder / "clip" / "config.yaml"
        subprocess.run([binaries / "hovermodal", "simulate", "--preset", "paper", "--size", "640x360", "--duration", "20", "--seed",
                        str(seed), "--out", self.config.parent], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.disk = folder / "disk"
        self.disk.mkdir()
        self.base = self.disk / "base.raw"
        with open(self.base, "wb") as empty:
            empty.truncate(DISK_BYTES)
        subprocess.run(["mke2fs", "-q", "-t", "ext4", "-E", "lazy_itable_init=0,lazy_journal_init=0", self.base], check=True)
        shutil.copyfile(self.base, self.disk / "disk.raw")
        self.ended, self.seen = {}, []  # run: bytes of the log; (bytes of the log, run, seconds, has a state, bytes of the record)
        self.fly()
        self.log = Log(self.disk / "writes.log")
        self.reports = {run: files_in(self.out / f"report_{run}") for run in self.ended}
        self.records = files_in(self.out / "records")

    def fly(self):
        guest = subprocess.Popen(
            [ROOT / "tests/device/guest.sh", "--out", self.out, "--timeout", "1500", "--disk", self.disk, "env",
             f"HOVERMODAL_BIN={self.binaries}", "tests/device/cases/power.sh", str(RUNS), self.config, *KEYS],
            cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
        said = []
        for line in guest.stdout:
            said.append(line)
            log_bytes = (self.disk / "writes.log").stat().st_size
            if match := re.match(r"run (\d+) ended with (\d+)", line):
                self.ended[int(match[1])] = log_bytes
                if match[2] != "0":
                    sys.exit(f"run {match[1]} in the virtual machine ended with {match[2]}: see {self.out}/run_{match[1]}.txt")
            elif match := re.match(r"run (\d+) at ([\d.]+) s: state (\d), record (\d+) bytes", line):
                self.seen.append((log_bytes, int(match[1]), float(match[2]), match[3] == "1", int(match[4])))
        if guest.wait() != 0 or len(self.ended) != RUNS:
            sys.exit("the virtual machine did not come to its end: " + "".join(said[-5:]))

    def first_entry(self):
        return self.log.index(self.seen[0][0])

    def ended_before(self, last):
        """The newest run that had ended at this entry; 0: none."""
        return max((run for run, end in self.ended.items() if end <= self.log.ends[last]), default=0)

    def must_have_state(self, last):
        at = self.log.ends[last]
        had = [seen for seen in self.seen if seen[3] and seen[1] == self.ended_before(last) + 1]
        return bool(had) and had[0][0] <= at <= had[-1][0]

    def record_lost_s(self, last, n_bytes):
        """Seconds of the record of the run that was cut that are not on the disk; None: that run had not begun."""
        run = [seen for seen in self.seen if seen[1] == self.ended_before(last) + 1]
        before = [seen for seen in run if seen[0] <= self.log.ends[last]]
        if not before:
            return None
        return before[-1][2] - max((seen[2] for seen in before if seen[4] <= n_bytes), default=before[0][2])


def recovered(image, folder):
    """What is on a disk after its journal was played; False: the file system cannot be repaired."""
    if subprocess.run(["e2fsck", "-fy", image], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode & ~3:
        return False
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    subprocess.run(["debugfs", "-R", f"rdump / {folder}", image], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return True


def next_start(flight, disk):
    """The words of the service that is started on what is left, until its first frames are in."""
    keys = [f"{key}.directory={disk / name}" for key, name in (("report", "report"), ("record", "next"), ("state", "state"))]
    arguments = [word for key in KEYS + keys for word in ("--set", key)]
    process = subprocess.Popen([flight.binaries / "hovermodald", "--config", flight.config, *arguments], stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True, errors="replace")
    said = []
    for line in process.stdout:
        said.append(line)
        if "masked; " in line or "masked, " in line or "the state in" in line:
            break
    process.send_signal(signal.SIGKILL)
    process.communicate()
    return "".join(said)


def faults_of_report(flight, disk, last):
    """In words; the service was started after the cut."""
    there = [disk / "report", *sorted((disk / "report").glob("report.[0-9]*"))]
    runs = [next((run for run, files in flight.reports.items() if files == files_in(folder)), None) for folder in there]
    newest = flight.ended_before(last)
    faults = [f"{folder.name} is the report of no run: {', '.join(sorted(files_in(folder))) or 'empty'}"
              for folder, run in zip(there, runs) if run is None and (folder.name != "report" or newest > 0)]
    if newest > 0 and not any(run is not None and run >= newest for run in runs):
        faults.append(f"the report of run {newest} is gone")
    return faults


def replayed(flight, record, folder):
    """The rows of displacements.csv that a replay makes of a record; or its words, where it fails."""
    shutil.rmtree(folder, ignore_errors=True)
    run = subprocess.run([flight.binaries / "hovermodal", "replay", record, "--report", folder, "--quiet"], capture_output=True, text=True,
                         timeout=120)
    rows = folder / "displacements.csv"
    return rows.read_text().splitlines() if run.returncode == 0 and rows.exists() else run.stderr.strip()[-200:]


def faults_of_records(flight, disk, last):
    """In words, and the seconds of the record of the run that was cut that are lost."""
    faults, newest, cut_bytes = [], flight.ended_before(last), 0
    for name, whole in flight.records.items():
        run = int(re.search(r"run(\d+)_", name)[1])
        path = disk / "records" / name
        kept = path.read_bytes() if path.exists() else b""
        written = len(os.path.commonprefix([kept, whole]))
        if len(kept) - written >= BLOCK or kept[written:].strip(b"\0"):
            faults.append(f"{name} holds what was never written")
        if run <= newest and kept != whole:
            faults.append(f"{name}: {len(kept)} bytes of {len(whole)} of a run that had ended")
        if run == newest + 1 and kept:
            cut_bytes = len(kept)
            rows, all_rows = replayed(flight, path, disk / "replay"), replayed(flight, flight.out / "records" / name, disk / "whole")
            if isinstance(rows, str):
                faults.append(f"{name}, {len(kept)} bytes: {rows}")
            elif rows[:-1] != all_rows[:len(rows) - 1]:
                faults.append(f"{name}: its replay differs from that of the whole record")
    return faults, flight.record_lost_s(last, cut_bytes)


def cut_once(flight, work, seed):
    draw = random.Random(seed)
    last = draw.randrange(flight.first_entry(), len(flight.log.entries))
    image, disk = work / "cut.raw", work / "cut"
    n_lost = flight.log.cut(flight.base, image, last, draw)
    if not recovered(image, disk):
        return ["the file system cannot be repaired"], None, n_lost, last, ""
    said = next_start(flight, disk)
    resumed = "goes on with the state" in said
    faults = faults_of_report(flight, disk, last)
    if "is not taken" in said:
        faults.append("the state cannot be read: " + said.strip()[-200:])
    if flight.must_have_state(last) and not resumed:
        faults.append("the state is gone")
    if not resumed and "masked" not in said:
        faults.append("the service does not start: " + said.strip()[-200:])
    more, lost_s = faults_of_records(flight, disk, last)
    return faults + more, lost_s, n_lost, last, "resumed" if resumed else "new"


def main():
    binaries, folder = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    cuts, first_seed = int(sys.argv[3]), int(sys.argv[4])
    if not shutil.which("qemu-system-x86_64"):
        sys.exit(77)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    flight = Flight(binaries, folder, first_seed)
    n_faulty, n_resumed, lost = 0, 0, []
    for k in range(cuts):
        faults, lost_s, n_lost, last, state = cut_once(flight, folder, first_seed + k)
        n_faulty += bool(faults)
        n_resumed += state == "resumed"
        if lost_s is not None:
            lost.append(lost_s)
        print("cut", first_seed + k, f"write {last} of {len(flight.log.entries)}", f"run {flight.ended_before(last) + 1}",
              f"{n_lost} writes lost", state, "-" if lost_s is None else f"{lost_s:.1f} s of record", "; ".join(faults) or "whole",
              sep="\t", flush=True)
    lost.sort()
    middle, worst = (lost[len(lost) // 2], lost[-1]) if lost else (float("nan"), float("nan"))
    print(f"faulty\t{n_faulty}\nresumed\t{n_resumed}\nrecord_lost_s\t{middle:.1f}\nrecord_lost_most_s\t{worst:.1f}")
    sys.exit(1 if n_faulty else 0)


if __name__ == "__main__":
    main()

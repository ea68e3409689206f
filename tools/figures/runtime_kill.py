#!/usr/bin/env python3
"""Kills hovermodald (SIGKILL) at random moments, lets it go on with its state each time, and keeps what each killed run left.
    runtime_kill.py BIN FOLDER KILLS FIRST_SEED [--report]
A simulated clip of six seconds is played at its own pace, from its beginning by each run. Kill number k falls at a moment
drawn from seed FIRST_SEED + k. Before and after the kills one run comes to its end: what it recorded is what a run without
interruption sees. FOLDER is then what kill_account reads. At the end damaged copies of the last state are offered to the
service, and it runs where its state cannot be written. With --report it writes a report over that of the first run, which every
kill must leave, and a further start shows after each kill that the state is resumed. Prints "name<TAB>value"; exit code 1 where a run does not do as a run does."""
import os
import random
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

PERIOD_S, CLIP_S, MOST_RUN_S = 2.0, 6, 4.2
DAMAGED_AT_MOST = 20


class Service:
    def __init__(self, binaries, folder, seed, reports):
        self.program, self.folder, self.state = binaries / "hovermodald", folder, folder / "state"
        clip = folder.parent / f"kill_clip_{seed}"
        subprocess.run([binaries / "hovermodal", "simulate", "--size", "640x360", "--duration", str(CLIP_S), "--seed", str(seed),
                        "--out", clip], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        # Regions of every seed have enough corners, close to each other. A ring as long as the clip: on a busy machine
        # frames wait instead of being dropped.
        keys = {"camera.pace": "realtime", "spectrum.segment": 32, "state.directory": self.state, "state.period_s": PERIOD_S,
                "record.directory": folder / "records", "telemetry.lcm_url": "", "closure.adopt": "off", "tracking.min_distance_px": 3,
                "rt.thin_overload": "false", "rt.frame_slots": 160, "rt.sample_slots": 256}
        if reports:
            keys["report.directory"] = folder / "report"
        self.arguments = [self.program, "--config", clip / "config.yaml"]
        for key, value in keys.items():
            self.arguments += ["--set", f"{key}={value}"]

    def start(self, first=()):
        return subprocess.Popen([*first, *self.arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def to_its_end(self, first=()):
        process = self.start(first)
        try:
            text = process.communicate(timeout=120)[0]
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            return None, "it hangs"
        return process.returncode, text

    def record_since(self, seen):
        new = sorted(set(self.folder.glob("records/*_000.lcm")) - seen)
        return new[-1] if new else None

    def records(self):
        return set(self.folder.glob("records/*_000.lcm"))

    def report(self):
        return {p.name: p.read_bytes() for p in (self.folder / "report").glob("*") if p.is_file()}

    def resumes(self):
        """Whether a start goes on with the state; it is killed as soon as it says so."""
        kept = (self.state / "hovermodal.state").read_bytes()
        process = self.start()
        while (line := process.stdout.readline()) and "goes on with the state" not in line and "is not taken" not in line:
            pass
        process.kill()
        process.communicate()
        (self.state / "hovermodal.state").write_bytes(kept)
        return "goes on with the state" in line


def whole_run(service, name):
    seen = service.records()
    code, text = service.to_its_end()
    if code != 0:
        sys.exit(f"{name}: a run to its end ended with {code}: {text[-300:]}")
    dropped = re.search(r"\+ (\d+) dropped", text)
    if not dropped or dropped.group(1) != "0":
        sys.exit(f"{name}: a run to its end dropped frames: {text[-300:]}")
    shutil.copy(service.record_since(seen), service.folder / name)


def kill_once(service, number, seed, log):
    """seed None: as late as any, so that a state is left."""
    kept, seen = (service.state / "hovermodal.keyframe").exists(), service.records()
    moment_s = MOST_RUN_S if seed is None else random.Random(seed).uniform(0.0, MOST_RUN_S)
    begin = last = time.monotonic()
    process = service.start()
    decodes_since = None  # no frame is taken before the clip has its decoder, the second thread of the process
    while (now := time.monotonic()) < begin + moment_s:
        if decodes_since is None and len(os.listdir(f"/proc/{process.pid}/task")) > 1:
            decodes_since = last
        last = now
        time.sleep(0.002)
    process.kill()
    after_s = time.monotonic() - decodes_since if decodes_since else 0.0
    text = process.communicate()[0]
    if process.returncode != -9:
        sys.exit(f"seed {seed}: the service ended with {process.returncode} before it was killed: {text[-300:]}")
    name = f"{number:04d}"
    state = service.state / "hovermodal.state"
    if state.exists():
        shutil.copy(state, service.folder / f"{name}.state")
    log.write(f"{name} {after_s:.6f} {int(kept)} {service.record_since(seen) or '-'}\n")
    return "is not taken" in text


def damaged(state, draw):
    data = bytearray(state)
    if draw.random() < 0.5:
        return bytes(data[:draw.randrange(len(data))])
    data[draw.randrange(len(data))] ^= 1 << draw.randrange(8)
    return bytes(data)


def offer_damaged(service, state, first_seed, n):
    """How many of n damaged states were refused in words, by a service that went on without."""
    n_refused = 0
    for seed in range(first_seed, first_seed + n):
        shutil.rmtree(service.state, ignore_errors=True)
        service.state.mkdir()
        (service.state / "hovermodal.state").write_bytes(damaged(state, random.Random(seed)))
        process = service.start()
        said = ""
        while "masked; " not in said and (line := process.stdout.readline()):
            said += line
            if "is not taken" in line or "goes on with the state" in line:
                break
        time.sleep(0.3)
        n_refused += "is not taken" in said and process.poll() is None
        process.kill()
        process.communicate()
    shutil.rmtree(service.state, ignore_errors=True)
    return n_refused


def unwritable(service, mount):
    """The service's own words where its state cannot be written; empty: it did not go on, or said nothing."""
    service.state.mkdir(exist_ok=True)
    script = f"mount {mount} hm \"{service.state}\" && exec \"$@\""
    for own in (["unshare", "-m"], ["unshare", "-rm"]):
        if subprocess.run([*own, "sh", "-c", script, "sh", "true"], stderr=subprocess.DEVNULL).returncode == 0:
            code, text = service.to_its_end([*own, "sh", "-c", script, "sh"])
            said = re.findall(r"(state could not be kept): .*?([^:\n]+)$", text, re.MULTILINE)
            return f"ended with {code}" if code != 0 else (": ".join(said[-1]) if said else "nothing was said")
    return "skip"


def main():
    reports = sys.argv[5:] == ["--report"]
    binaries, folder = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    kills, first_seed = int(sys.argv[3]), int(sys.argv[4])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    service = Service(binaries, folder, first_seed, reports)
    whole_run(service, "first.lcm")
    old, n_kept, n_resumed = service.report(), 0, 0
    n_refused = 0
    with open(folder / "kills.tsv", "w", encoding="utf-8") as log:
        if reports:
            kill_once(service, kills, None, log)
        for k in range(kills):
            n_refused += kill_once(service, k, first_seed + k, log)
            if reports:
                n_kept += service.report() == old and "modal.json" in old
                n_resumed += service.resumes()
    states = sorted(folder.glob("*.state"))
    if not states:
        sys.exit("no state was written")
    last = states[-1].read_bytes()
    whole_run(service, "again.lcm")
    n = min(DAMAGED_AT_MOST, kills)
    if reports:
        print(f"reports_kept\t{n_kept}\nstarts_resumed\t{n_resumed}")
        return
    print(f"refused\t{n_refused}\ndamaged\t{n}\ndamaged_refused\t{offer_damaged(service, last, first_seed, n)}")
    print(f"full\t{unwritable(service, '-t tmpfs -o size=16k')}\nread_only\t{unwritable(service, '-t tmpfs -o ro')}")
    shutil.rmtree(service.state, ignore_errors=True)


if __name__ == "__main__":
    os.umask(0o022)
    main()

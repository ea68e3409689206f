#!/usr/bin/env python3
"""Stops the service at random moments and looks at what it leaves.
    runtime_stop.py BIN FOLDER STOPS FIRST_SEED
Simulates a clip once, then runs hovermodald on it again and again while two processes keep the CPUs busy, sends SIGTERM
or SIGINT at a random moment (seeds FIRST_SEED on), and measures the time from the signal to the end of the stages and to
the end of the process. Prints both; exit code 1 when a report is incomplete, a message in the event log does not decode,
an exit code is not 0, or stages took longer than 300 ms plus the longest step of the run."""
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

REPORT = ("modal.json", "tracks.csv", "displacements.csv", "report.html")


def fail(text):
    print(text)
    sys.exit(1)


def prepare(binaries, folder, seed):
    clip = folder / f"clip_{seed}"
    subprocess.run([binaries / "hovermodal", "simulate", "--size", "640x360", "--duration", "30", "--seed", str(seed), "--out", clip],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return clip / "config.yaml"


def start(binaries, config, out):
    arguments = ["--config", config, "--report", out, "--set", "telemetry.lcm_url=", "--set", f"telemetry.log_file={out}/log.lcm",
                 "--set", "camera.pace=realtime", "--set", "spectrum.segment=64", "--set", "tracking.min_distance_px=3"]
    return subprocess.Popen([binaries / "hovermodald", *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def longest_step_ms(text):
    found = re.search(r"longest step ([0-9.]+) ms", text)
    return float(found.group(1)) if found else 0.0


def stop_once(binaries, config, out, seed):
    choose = random.Random(seed)
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    service = start(binaries, config, out)
    os.set_blocking(service.stdout.fileno(), True)
    first = service.stdout.readline()  # the source is open, so the signal mask is set
    time.sleep(choose.uniform(0.0, 3.0))
    begin = time.monotonic()
    service.send_signal(choose.choice((signal.SIGTERM, signal.SIGINT)))
    try:
        text = first + service.communicate(timeout=60)[0]
    except subprocess.TimeoutExpired:
        service.kill()
        return None, None, None, f"seed {seed}: hangs"
    whole_ms = 1e3 * (time.monotonic() - begin)
    stages = re.search(r"stages stopped ([0-9.]+) ms after the request", text)
    problem = ""
    if service.returncode != 0:
        problem = f"seed {seed}: exit code {service.returncode}: {text[-300:]}"
    for name in REPORT:
        if not (out / name).exists() or (out / f"{name}.partial").exists():
            problem = f"seed {seed}: {name} is missing or partial"
    if not problem:
        losses = json.loads((out / "modal.json").read_text())["losses"]
        if losses["frames_in"] != losses["frames_processed"] + losses["frames_dropped"]:
            problem = f"seed {seed}: frames do not add up: {losses}"
        count = out / "count.json"
        spy = subprocess.run([binaries / "hovermodal", "spy", "--url", f"file://{out}/log.lcm?speed=0", "--plain", "--once",
                              "--count", count], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if spy.returncode != 0 or not json.loads(count.read_text())["complete"]:
            problem = f"seed {seed}: a message is torn or missing: {spy.stdout[-200:]}"
    return whole_ms, float(stages.group(1)) if stages else None, longest_step_ms(text), problem


def main():
    binaries, folder, stops = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve(), int(sys.argv[3])
    first_seed = int(sys.argv[4])
    folder.mkdir(parents=True, exist_ok=True)
    config = prepare(binaries, folder, first_seed)
    load = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(2)]
    stage_ms, whole_ms, over = [], [], []
    try:
        for seed in range(first_seed, first_seed + stops):
            whole, stages, longest, problem = stop_once(binaries, config, folder / "run", seed)
            if problem:
                fail(problem)
            if stages is None:
                fail(f"seed {seed}: the service does not say when its stages ended")
            stage_ms.append(stages)
            whole_ms.append(whole)
            over.append(stages - longest)
    finally:
        for process in load:
            process.kill()
    stage_ms.sort(), whole_ms.sort()
    middle = len(stage_ms) // 2
    print(f"stages {stage_ms[middle]:.0f} ms median, {stage_ms[-1]:.0f} worst ({max(over):.0f} beyond the longest step); "
          f"process {whole_ms[middle]:.0f} median, {whole_ms[-1]:.0f} worst; {stops} of {stops} reports complete")
    sys.exit(0 if max(over) <= 300.0 else 1)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""A wall clock that steps by an hour, forward and back, at every call changes no result.
    clock_runs.py BIN LIBRARY FOLDER
Runs the service on a simulated clip with and without the preloaded clock_steps, with report, record and state on, and compares every byte of
modal.json, tracks.csv and displacements.csv; the record of the stepped run is replayed to the same bytes. Exit code 1 where one differs."""
import os
import shutil
import subprocess
import sys
from pathlib import Path

RESULTS = ("modal.json", "tracks.csv", "displacements.csv")


def run(command, library=None):
    environment = dict(os.environ, **({"LD_PRELOAD": str(library)} if library else {}))
    done = subprocess.run([str(a) for a in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300, env=environment)
    if done.returncode != 0:
        sys.exit(f"{command[0]} ended with {done.returncode}: {done.stdout[-500:]}")
    return done.stdout


def main():
    binaries, library, folder = (Path(a).resolve() for a in sys.argv[1:4])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    run([binaries / "hovermodal", "simulate", "--size", "640x360", "--duration", "12", "--seed", "5", "--out", folder / "clip"])
    reports = {}
    for name, steps in (("steady", None), ("stepped", library)):
        keys = {"telemetry.lcm_url": "", "closure.adopt": "off", "spectrum.segment": 64, "identification.period": 1, "tracking.min_distance_px": 3,
                "report.directory": folder / name, "record.directory": folder / f"{name}_record", "state.directory": folder / f"{name}_state",
                "state.period_s": 1}
        run([binaries / "hovermodald", "--config", folder / "clip" / "config.yaml", *(a for k, v in keys.items() for a in ("--set", f"{k}={v}"))], steps)
        reports[name] = folder / name
    record = sorted((folder / "stepped_record").glob("*_000.lcm"))
    if len(record) != 1:
        sys.exit(f"{len(record)} records of one run")
    run([binaries / "hovermodal", "replay", record[0], "--report", folder / "replayed"], library)
    reports["replayed"] = folder / "replayed"
    wrong = [f"{name}/{file}" for name, report in reports.items() for file in RESULTS
             if (report / file).read_bytes() != (reports["steady"] / file).read_bytes()]
    print(f"{len(reports)} reports of {len(RESULTS)} files; that differ from the steady run's: {', '.join(wrong) or 'none'}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Records that lose 30 % of their frames, by the public programs: `hovermodal simulate` draws the tracks, `hovermodal replay`
identifies them, once as they are and once with the losses.
    runtime_loss.py BIN FOLDER SECONDS FIRST_SEED RECORDS
A mode of the truth that the record without losses shows (within 2 %) must be shown by the one with them. Prints
"name<TAB>value"."""
import json
import subprocess
import sys
from pathlib import Path

NEAR = 0.02


def frequencies(modal):
    return [mode["frequency_hz"] for mode in json.loads(modal.read_text())["modes"]]


def identify(binaries, folder, seconds, seed, share):
    folder.mkdir(parents=True, exist_ok=True)
    scene = folder / "scene.yaml"
    scene.write_text(f"preset: paper\nduration_s: {seconds}\nseed: {seed}\ntiming: {{drop_probability: {share}}}\n")
    for command in ([binaries / "hovermodal", "simulate", "--scene", scene, "--tracks-only", "--points", "15", "--out", folder],
                    [binaries / "hovermodal", "replay", "--tracks", folder / "tracks.csv", "--config", folder / "config.yaml",
                     "--set", "telemetry.lcm_url=", "--report", folder / "report"]):
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode != 0:
            sys.exit(f"seed {seed}: {done.stdout[-300:]}")
    report = json.loads((folder / "report" / "modal.json").read_text())
    truth = frequencies(folder / "truth.json")
    found = frequencies(folder / "report" / "modal.json")
    off = [min((abs(f / t - 1) for f in found), default=1.0) for t in truth]
    return truth, off, report["losses"]


def main():
    binaries, folder = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    seconds, first, records = int(sys.argv[3]), int(sys.argv[4]), int(sys.argv[5])
    n_shown = n_lost = n_records = n_low_records = n_uneven = n_missing = n_frames = 0
    worst, which = 0.0, []
    for seed in range(first, first + records):
        truth, whole, _ = identify(binaries, folder / f"{seed}_whole", seconds, seed, 0.0)
        _, lossy, losses = identify(binaries, folder / f"{seed}_lossy", seconds, seed, 0.3)
        shown = [i for i in range(len(truth)) if whole[i] < NEAR]
        lost = [i for i in shown if not lossy[i] < NEAR]
        n_shown, n_lost, n_records = n_shown + len(shown), n_lost + len(lost), n_records + (len(lost) > 0)
        n_low_records += any(i < 3 for i in lost)
        worst = max([worst] + [lossy[i] for i in shown if i not in lost])
        which += [f"seed {seed}: {', '.join(f'{truth[i]:.2f} Hz' for i in lost)}"] if lost else []
        n_uneven += losses["frames_in"] != losses["frames_processed"] + losses["frames_dropped"]
        n_missing, n_frames = n_missing + losses["frames_missing"], n_frames + losses["frames_in"]
    print(f"records\t{records}\nrecords_with_a_lost_mode\t{n_records}\nrecords_with_one_of_three\t{n_low_records}\nshown\t{n_shown}\nlost\t{n_lost}\nworst_percent\t{100 * worst:.2f}")
    print(f"uneven\t{n_uneven}\nmissing_percent\t{100 * n_missing / max(1, n_missing + n_frames):.1f}\nwhich\t{'; '.join(which) or 'none'}")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Hours of stream through hovermodald as fast as it goes, with report, record, state, residual diagnosis, ground page and spy on: memory
and descriptors of the three programs, and whether a second run gives the same bytes.
    endurance_day.py BIN FOLDER HOURS FIRST_SEED
A rendered clip of two minutes is repeated without being encoded again. Resident memory is sampled four times a second until the last
frame. Residual diagnosis takes memory for some seconds of every minute and gives it back, so the slope is that of the line through the
least of every ten minutes of stream, without the first ten: what is not given back. In kB a minute of stream; the slope of the means is
printed beside. Needs a network of its own (unshare). FOLDER: is emptied; it needs 0.6 GB an hour. Prints "name<TAB>value"."""
import collections
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import threading
import time
from pathlib import Path

URL = "udpm://239.255.76.67:7667?ttl=0"
CLIP_S, PART_S = 120, 600
KEYS = {"tracking.min_distance_px": 3, "tracking.points_per_region": 8, "telemetry.lcm_url": URL, "telemetry.preview_period_s": 5}


def make_clip(binaries, folder, hours, seed):
    """Returns its configuration and the repeated clip."""
    subprocess.run([binaries / "hovermodal", "simulate", "--preset", "paper", "--size", "640x360", "--duration", str(CLIP_S), "--seed", str(seed),
                    "--out", folder / "clip"], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    short, long = folder / "short.mp4", folder / "long.mp4"
    ffmpeg = ["ffmpeg", "-nostdin", "-loglevel", "error", "-y"]
    subprocess.run([*ffmpeg, "-i", folder / "clip" / "clip.mp4", "-c:v", "libx264", "-preset", "fast", "-crf", "26", short], check=True)
    subprocess.run([*ffmpeg, "-stream_loop", str(round(hours * 3600 / CLIP_S) - 1), "-i", short, "-c", "copy", long], check=True)
    (folder / "clip" / "clip.mp4").unlink()
    return folder / "clip" / "config.yaml", long


def kilobytes(pid):
    with open(f"/proc/{pid}/status", encoding="ascii") as status:
        return int(re.search(r"VmRSS:\s+(\d+)", status.read())[1])


def descriptors(pid):
    """What each of them is; a number in a name, such as that of a record's file, is no difference."""
    folder, out = f"/proc/{pid}/fd", []
    for name in os.listdir(folder):
        try:
            out.append(re.sub(r"\d+", "#", os.path.basename(os.readlink(f"{folder}/{name}"))))
        except OSError:  # closed meanwhile
            out.append("closed")
    return collections.Counter(out)


def open_for_a_moment(samples, name):
    """What a program had open beyond its fewest descriptors, with the number of samples."""
    fewest = min((s[name + "_open"] for s in samples), key=collections.Counter.total)
    return sum((s[name + "_open"] - fewest for s in samples), collections.Counter())


def slope(parts, of):
    """Of a number of each part, over minutes of stream."""
    minutes, values = [k * PART_S / 60 for k in range(len(parts))], [of(part) for part in parts]
    m, v = sum(minutes) / len(parts), sum(values) / len(parts)
    spread = sum((a - m) ** 2 for a in minutes)
    return sum((a - m) * (b - v) for a, b in zip(minutes, values)) / spread if spread > 0 else float("nan")


class Sampler(threading.Thread):
    """Memory and descriptors of the programs while `stream_s` goes on."""

    def __init__(self, programs):
        super().__init__(daemon=True)
        self.programs, self.samples, self.stream_s, self.over = programs, [], 0.0, threading.Event()

    def run(self):
        while not self.over.wait(0.25):
            try:
                sample = {"t": self.stream_s}
                for name, process in self.programs.items():
                    sample[name], sample[name + "_open"] = kilobytes(process.pid), descriptors(process.pid)
                    sample[name + "_fd"] = sample[name + "_open"].total()
                self.samples.append(sample)
            except (OSError, TypeError):  # it has just ended
                return

    def parts(self):
        """Of PART_S each, without the first; the last may be shorter."""
        out = {}
        for sample in self.samples:
            out.setdefault(int(sample["t"] // PART_S), []).append(sample)
        return [out[k] for k in sorted(out) if k > 0 and len(out[k]) > 8]


class Day:
    def __init__(self, binaries, folder, hours, seed):
        self.binaries, self.folder = binaries, folder
        self.config, self.clip = make_clip(binaries, folder, hours, seed)

    def beside(self):
        """The programs of the ground station, and a browser's place."""
        spy = subprocess.Popen([self.binaries / "hovermodal", "spy", "--url", URL, "--plain"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        ground = subprocess.Popen([self.binaries / "hovermodal", "ground", "--url", URL, "--port", "8086"], stdout=subprocess.DEVNULL,
                                  stderr=subprocess.DEVNULL)
        time.sleep(2)
        browser = subprocess.Popen(["curl", "-sN", "http://127.0.0.1:8086/events"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return {"spy": spy, "ground": ground}, browser

    def run(self, name):
        """Its sampler, exit code, whether the browser's connection lived, the service's words."""
        keys = {**KEYS, "camera.source": self.clip, "state.directory": self.folder / f"{name}_state",
                "record.directory": self.folder / f"{name}_record", "report.directory": self.folder / name}
        arguments = [word for key, value in keys.items() for word in ("--set", f"{key}={value}")]
        programs, browser = self.beside()
        service = subprocess.Popen([self.binaries / "hovermodald", "--config", self.config, *arguments], stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True)
        programs["service"] = service
        sampler, words, n_lines = Sampler(programs), [], 0
        sampler.start()
        for line in service.stdout:
            words.append(line.rstrip())
            if match := re.search(r"frame \d+ of \d+ .*, ([\d.]+) s of stream", line):
                sampler.stream_s = float(match[1])
                n_lines += 1
                if n_lines % 20 == 1:
                    print(f"{name}: {match[1]} s of stream", file=sys.stderr)
            elif "frames in" in line:  # the last frame
                sampler.over.set()
        code = service.wait()
        browser_lived = browser.poll() is None
        for process in (*(programs[p] for p in ("spy", "ground")), browser):
            process.terminate()
            process.wait()
        with open(self.folder / f"{name}.samples.json", "w", encoding="ascii") as kept:
            json.dump(sampler.samples, kept)
        return sampler, code, browser_lived, words

    def digests(self, name):
        """Of every file of a report; the page without its section on the run's times."""
        out = {}
        for path in sorted((self.folder / name).iterdir()):
            if not path.is_file():
                continue
            digest = hashlib.sha256()
            if path.name == "report.html":
                page = path.read_text(encoding="utf-8")
                digest.update(re.sub(r'(?s)<section[^>]*id="timing".*?</section>', "", page).encode())
            else:
                with open(path, "rb") as data:
                    while block := data.read(1 << 20):
                        digest.update(block)
            out[path.name] = digest.hexdigest()
        return out


def main():
    binaries, folder = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    hours, seed = float(sys.argv[3]), int(sys.argv[4])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    day = Day(binaries, folder, hours, seed)
    sampler, code, browser_lived, words = day.run("first")
    first = day.digests("first")
    (folder / "first" / "tracks.csv").unlink(missing_ok=True)  # its digest stays, and gigabytes are free again
    shutil.rmtree(folder / "first_record")
    _, code_again, _, _ = day.run("second")
    second = day.digests("second")
    parts = sampler.parts()
    settled = [sample for part in parts for sample in part]
    print(f"code\t{code} {code_again}\nhours\t{sampler.stream_s / 3600:.2f}\nparts\t{len(parts)}\nbrowser\t{int(browser_lived)}")
    for name in ("service", "ground", "spy"):
        least, mean = (slope(parts, lambda part, f=f: f([s[name] for s in part])) for f in (min, lambda v: sum(v) / len(v)))
        print(f"{name}_slope\t{least:.3f}\n{name}_mean_slope\t{mean:.3f}\n{name}_first\t{min(s[name] for s in parts[0])}")
        print(f"{name}_last\t{min(s[name] for s in parts[-1])}\n{name}_most\t{max(s[name] for s in settled)}")
        print(f"{name}_fd\t{min(s[name + '_fd'] for s in settled)} {max(s[name + '_fd'] for s in settled)}")
        held = [min(s[name + "_fd"] for s in part) for part in parts]
        print(f"{name}_held\t{min(held)} {max(held)}")
    momentary = ", ".join(f"{what} {n}" for what, n in open_for_a_moment(settled, "service").most_common(8))
    print(f"samples\t{len(settled)}\nfor_a_moment\t{momentary or 'nothing'}")
    different = sorted(name for name in first.keys() | second.keys() if first.get(name) != second.get(name))
    print(f"files\t{len(first)}\ndifferent\t{len(different)} {' '.join(different)}\nwords\t{next((w for w in words if 'frames in' in w), 'none')}")


if __name__ == "__main__":
    main()

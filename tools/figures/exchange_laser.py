# Figure 2 of exchange.sh: a simulated laser, and the truth that compare --sensor is measured against.
#   exchange_laser.py make TRUTH CHANNEL OUT SEED      OUT: a laser's record of the true motion
#   exchange_laser.py score TRUTH CHANNEL RUN SENSOR_JSON
# TRUTH: truth_displacements.csv at a high rate. The laser's clock starts 0.3 s late and runs 50 ppm fast; noise 0.006 mm rms.
# score prints "OFFSET ERROR / SIGMA, RATE ERROR / SIGMA, RMSE, TRUE RMSE, R, AMPLITUDE ERROR / SIGMA, PX RMSE, SIGMA OF OFFSET ms".
# The true RMSE is computed here, from the run's displacements.csv and the true motion at the instants at which the channel was
# seen, by sines and cosines within the band: without the code under test.
import json
import math
import random
import sys

LATE_S, FAST, NOISE_MM = 0.3, 50e-6, 0.006


def table(path):
    comments, names, rows = {}, None, []
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.startswith("#"):
                key, _, value = line[1:].strip().partition(": ")
                comments[key] = value
            elif names is None:
                names = line.strip().split(",")
            else:
                rows.append([float(cell) if cell else math.nan for cell in line.rstrip("\n").split(",")])
    return comments, names, rows


class Truth:
    """The true motion at any instant: the cubic through four samples."""

    def __init__(self, path, channel):
        _, names, rows = table(path)
        self.first, self.rate = rows[0][1], 1.0 / (rows[1][1] - rows[0][1])
        self.value = [row[names.index(channel)] for row in rows]

    def end(self):
        return self.first + (len(self.value) - 1) / self.rate

    def at(self, t):
        place = (t - self.first) * self.rate
        k = min(max(int(math.floor(place)), 1), len(self.value) - 3)
        x, (a, b, c, d) = place - k, self.value[k - 1:k + 3]
        return b + 0.5 * x * (c - a + x * (2 * a - 5 * b + 4 * c - d + x * (3 * (b - c) + d - a)))


def make(truth_path, channel, out, seed):
    truth, noise = Truth(truth_path, channel), random.Random(int(seed) * 7919 + 17)
    rate = 500.0
    with open(out, "w", encoding="utf-8") as file:
        file.write("t_s,laser [mm]\n")
        k = 0
        while True:
            t = LATE_S + k / rate / (1 + FAST)
            if t > truth.end():
                break
            file.write(f"{k / rate:.3f},{truth.at(t) + noise.gauss(0.0, NOISE_MM):.6f}\n")
            k += 1


def band_rms(values, rate, low, high, first, last):
    """RMS of samples first .. last of what lies within the band: a series of sines of the record less the line through its
    ends, which is the record turned about its ends (core/compare/METHOD.md)."""
    n = len(values)
    line = (values[-1] - values[0]) / (n - 1)
    values = [value - values[0] - line * k for k, value in enumerate(values)]
    band = [0.0] * n
    edge = max(0.05 * (high - low), 2 * rate / n)  # limits with half the power
    for m in range(math.ceil((low - edge / 2) * 2 * n / rate), math.floor((high + edge / 2) * 2 * n / rate) + 1):
        f = m * rate / (2 * (n - 1))
        weight = 1.0
        for beyond in (f - low, high - f):
            weight *= math.sin(math.pi / 2 * min(1.0, max(0.0, beyond / edge + 0.5)))
        step = complex(math.cos(math.pi * m / (n - 1)), math.sin(math.pi * m / (n - 1)))
        wave, sines = 1 + 0j, []
        for _ in range(n):
            sines.append(wave.imag)
            wave *= step
        amplitude = weight * 2 / (n - 1) * sum(map(lambda a, b: a * b, values, sines))
        for k in range(n):
            band[k] += amplitude * sines[k]
    return math.sqrt(sum(value * value for value in band[first:last + 1]) / (last + 1 - first))


def exposure_s(run):
    with open(run + "/tracks.csv", encoding="utf-8") as file:
        for line in file:
            if line.startswith("# exposure_ms:"):
                return 1e-3 * float(line.split(":")[1])
    return 0.0


def score(truth_path, channel, run, sensor_json):
    truth = Truth(truth_path, channel)
    comments, names, rows = table(run + "/displacements.csv")
    with open(sensor_json, encoding="utf-8") as file:
        found = json.load(file)
    delay = float(comments["row_delay_s." + channel]) + exposure_s(run) / 2
    rate, column = float(comments["rate_hz"]), names.index(channel)
    differences, times = [], []
    for row in rows:
        t = row[1] + delay
        if truth.first <= t <= truth.end():
            differences.append(row[column] - truth.at(t))
            times.append(t)
    for k in range(1, len(differences)):  # a missing sample: as the one before
        if math.isnan(differences[k]):
            differences[k] = differences[k - 1]
    inside = [k for k, t in enumerate(times) if found["from_s"] - 1e-9 <= t <= found["to_s"] + 1e-9]
    true_rmse = band_rms(differences, rate, *found["band_hz"], inside[0], inside[-1])
    middle = found["offset_at_camera_s"]
    true_offset = (middle - LATE_S) * (1 + FAST) - middle
    print((found["offset_s"] - true_offset) / found["offset_std_s"], (found["rate_ppm"] - 1e6 * FAST) / found["rate_std_ppm"],
          found["rmse"], true_rmse, found["correlation"], (found["amplitude_ratio"] - 1) / found["amplitude_ratio_std"],
          found["rmse_px"], 1e3 * found["offset_std_s"])


make(*sys.argv[2:]) if sys.argv[1] == "make" else score(*sys.argv[2:])

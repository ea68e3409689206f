#!/usr/bin/env python3
"""A region for each dot of the knex clip, and how near its tracks come to the given centroids.

tracking_knex.py config FOLDER             the service's configuration, on standard output
tracking_knex.py compare FOLDER TRACKS     a line a row, then: share of positions within 0.5 px in percent, dots lost
"""
import collections
import csv
import statistics
import sys

HALF_PX = 22.0  # of a dot and its surroundings
PER_ROW = 7


def centroids(folder):
    with open(f"{folder}/target_centroids_px.csv") as lines:
        rows = list(csv.reader(lines))[1:]
    return [[(float(r[1 + 2 * t]), float(r[2 + 2 * t])) for t in range((len(r) - 1) // 2)] for r in rows]


def config(folder):
    first = centroids(folder)[0]
    print(f"camera: {{source: '{folder}/knex_1300x2046_gray.mp4', rate_hz: 20}}\nregions:")
    for t, (u, v) in enumerate(first):
        role = "base" if t < PER_ROW else "structure"
        side = 2.0 * HALF_PX
        print(f"  - {{name: t{t:02}, rect: [{u - HALF_PX:.0f}, {v - HALF_PX:.0f}, {side:.0f}, {side:.0f}], role: {role}, axis: both}}")
    print("scale: {adaptive: false}\nspectrum: {segment: 64}")
    print("identification: {period: 1000}\ntelemetry: {lcm_url: ''}\nreport: {tracks: true}")


def compare(folder, tracks):
    truth = centroids(folder)
    dots = len(truth[0])
    points = collections.defaultdict(dict)
    with open(tracks) as lines:
        for row in csv.DictReader(line for line in lines if not line.startswith("#")):
            points[row["point"]][int(row["frame"])] = (float(row["u_px"]), float(row["v_px"]))
    of_dot = collections.defaultdict(list)
    for seen in points.values():
        if 0 not in seen:
            continue
        u, v = seen[0]
        near = min(range(dots), key=lambda t: (truth[0][t][0] - u) ** 2 + (truth[0][t][1] - v) ** 2)
        if abs(truth[0][near][0] - u) <= HALF_PX and abs(truth[0][near][1] - v) <= HALF_PX:
            of_dot[near].append(seen)
    n_good, n_lost = 0, 0
    good_of_row = collections.Counter()
    for t in range(dots):
        off = {}
        for k in range(len(truth)):
            steps = [(p[k][0] - p[0][0], p[k][1] - p[0][1]) for p in of_dot[t] if k in p]
            if steps:
                off[k] = tuple(statistics.fmean(s[a] for s in steps) - (truth[k][t][a] - truth[0][t][a]) for a in (0, 1))
        middle = [statistics.median(e[a] for e in off.values()) if off else 0.0 for a in (0, 1)]
        good = sum((e[0] - middle[0]) ** 2 + (e[1] - middle[1]) ** 2 <= 0.25 for e in off.values())
        n_good += good
        good_of_row[t // PER_ROW] += good
        n_lost += not off or max(off) < len(truth) - 50
    for row, good in sorted(good_of_row.items()):
        print(f"# row {row}: {100.0 * good / (PER_ROW * len(truth)):.2f} %")
    print(f"{100.0 * n_good / (dots * len(truth)):.2f} {n_lost}")


if len(sys.argv) == 3 and sys.argv[1] == "config":
    config(sys.argv[2])
elif len(sys.argv) == 4 and sys.argv[1] == "compare":
    compare(sys.argv[2], sys.argv[3])
else:
    sys.exit(__doc__)

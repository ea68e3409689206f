"""Motion of regions in a magnified video against what magnify drew. Called by exchange_pages.sh.

  exchange_magnified.py DRAWN.json TRACKS.csv     one line per region: name, drawn px, measured px, error px, held (tabs between them)
"""
import json
import math
import sys


def solved(matrix, right):
    """The solution of a small system, by elimination with the largest pivot."""
    rows = [list(row) + [value] for row, value in zip(matrix, right)]
    n = len(rows)
    for i in range(n):
        best = max(range(i, n), key=lambda k: abs(rows[k][i]))
        rows[i], rows[best] = rows[best], rows[i]
        for k in range(n):
            if k != i:
                factor = rows[k][i] / rows[i][i]
                rows[k] = [x - factor * y for x, y in zip(rows[k], rows[i])]
    return [rows[i][n] / rows[i][i] for i in range(n)]


def swing_of(places, axis, step):
    """Least squares of offset, cosine and sine over the frames in which a point is seen: x = offset + Re(swing e^(i step frame))."""
    terms = [(1.0, math.cos(step * frame), -math.sin(step * frame)) for frame in places]
    matrix = [[sum(t[i] * t[j] for t in terms) for j in range(3)] for i in range(3)]
    right = [sum(t[i] * place[axis] for t, place in zip(terms, places.values())) for i in range(3)]
    _, real, imaginary = solved(matrix, right)
    return complex(real, imaginary)


def measured_swings(path, rate_hz, hz):
    """Per region the complex swing (u, v): mean over the points that are seen in nine of ten frames."""
    points, regions, n_frames = {}, {}, 0
    with open(path, encoding="utf-8") as table:
        for line in table:
            if line.startswith(("#", "frame")):
                continue
            frame, _, point, region, u, v, _ = line.rstrip("\n").split(",")
            points.setdefault(int(point), {})[int(frame)] = (float(u), float(v))
            regions[int(point)] = region
            n_frames = max(n_frames, int(frame) + 1)
    step, sums = 2 * math.pi * hz / rate_hz, {}
    for point, places in points.items():
        if len(places) < 0.9 * n_frames:
            continue
        n, u, v = sums.get(regions[point], (0, 0, 0))
        sums[regions[point]] = (n + 1, u + swing_of(places, 0, step), v + swing_of(places, 1, step))
    return {region: (u / n, v / n) for region, (n, u, v) in sums.items()}


def main():
    drawn = json.load(open(sys.argv[1], encoding="utf-8"))
    swings = measured_swings(sys.argv[2], drawn["rate_hz"], 1 / drawn["period_s"])
    for region in drawn["regions"]:
        wanted = [complex(*region["drawn_u_px"]), complex(*region["drawn_v_px"])]
        got = swings.get(region["name"])
        size = math.hypot(*map(abs, wanted))
        if got is None:
            print(region["name"], f"{size:.4f}", "nan", "nan", region["held"] or "-", sep="\t")
            continue
        error = math.hypot(abs(got[0] - wanted[0]), abs(got[1] - wanted[1]))
        print(region["name"], f"{size:.4f}", f"{math.hypot(*map(abs, got)):.4f}", f"{error:.4f}", region["held"] or "-", sep="\t")


if __name__ == "__main__":
    main()

"""What tools/figures/shipping_batch.sh asks of batch.json.
  batch_account.py same A B        how many numbers, and their largest relative difference (inf: other modes or flights)
  batch_account.py truth A TRUTH   modes of the truth found; largest sigma over that of the best flight, and over that of
                                   the median flight; largest and rms error in standard deviations, of frequencies and damping"""
import json
import math
import statistics
import sys


def numbers(value, path=""):
    """All leaves with their places."""
    if isinstance(value, dict):
        for key, part in value.items():
            yield from numbers(part, f"{path}.{key}")
    elif isinstance(value, list):
        for i, part in enumerate(value):
            yield from numbers(part, f"{path}[{i}]")
    else:
        yield path, value


def same(a, b):
    one, other = dict(numbers(a)), dict(numbers(b))
    if one.keys() != other.keys():
        return 0, math.inf
    n, largest = 0, 0.0
    for place, value in one.items():
        if isinstance(value, float) and isinstance(other[place], float):
            n += 1
            largest = max(largest, abs(value - other[place]) / max(abs(value), 1e-300))
        elif value != other[place]:
            return 0, math.inf
    return n, largest


def truth(batch, true):
    found, of_best, of_median, errors = 0, [], [], []
    for mode in true["modes"]:
        near = [m for m in batch["modes"] if abs(m["frequency_hz"]["value"] / mode["frequency_hz"] - 1) < 0.03]
        if not near:
            continue
        found += 1
        for key, std in (("frequency_hz", "frequency_std_hz"), ("damping_ratio", "damping_std")):
            together = near[0][key]
            single = [f[std] for f in near[0]["by_flight"] if f[std] is not None]
            of_best.append(together["std"] / min(single))
            of_median.append(together["std"] / statistics.median(single))
            errors.append(abs(together["value"] - mode[key]) / together["std"])
    if not errors:
        return found, math.nan, math.nan, math.nan, math.nan
    rms = math.sqrt(sum(e * e for e in errors) / len(errors))
    return found, f"{max(of_best):.3f}", f"{max(of_median):.3f}", f"{max(errors):.2f}", f"{rms:.2f}"


def main():
    what, *paths = sys.argv[1:]
    files = []
    for path in paths:
        with open(path, encoding="utf-8") as file:
            files.append(json.load(file))
    print(*(same if what == "same" else truth)(*files))


main()

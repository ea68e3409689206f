"""Records of many channels for tools/figures/trust.sh 7: draws them, runs a program on them, scores shapes.

    full_field.py make CHANNELS SEED RECORD.mat      300 s at 30 Hz: 12 modes of a chain under white forces, 1 % damping
    full_field.py run OUT COMMAND...                 its standard output to OUT; prints seconds and peak memory in MB
    full_field.py score RESULT.json CHANNELS         prints modes found, others, least MAC, rms error in stated sigmas
    full_field.py numpy RECORD.mat RESULT.json       the same by NumPy and SciPy: six references, canonical variates of them,
                                                     shapes of all channels by least squares
"""
import json
import math
import resource
import subprocess
import sys
import time

MODES, RATE_HZ, SECONDS, DAMPING, NOISE = 12, 30.0, 300, 0.01, 0.02


def angle(mode):
    return math.pi * (2 * mode + 1) / (2 * MODES + 1) / 2


def frequency_hz(mode):
    return 13.0 * math.sin(angle(mode))


def shape(mode, n):
    return [math.sin(2 * angle(mode) * (c + 1) * MODES / n) for c in range(n)]


def make(n, seed, path):
    import numpy
    from scipy.io import savemat
    from scipy.signal import lfilter

    draw = numpy.random.default_rng(seed)
    length = int(RATE_HZ * SECONDS)
    value = numpy.zeros((length, n))
    for mode in range(MODES):
        w = 2 * math.pi * frequency_hz(mode) / RATE_HZ
        r = math.exp(-DAMPING * w)
        force = draw.standard_normal(length + 2000)
        moved = lfilter([math.sqrt(w)], [1, -2 * r * math.cos(w * math.sqrt(1 - DAMPING**2)), r * r], force)[2000:]
        value += numpy.outer(moved, shape(mode, n))
    value += NOISE * value.std() * draw.standard_normal(value.shape)
    savemat(path, {"rate_hz": RATE_HZ, **{f"p{c + 1}": value[:, c] for c in range(n)}})


def run(out, command):
    begin = time.monotonic()
    with open(out, "w") as file:
        subprocess.run(command, stdout=file, stderr=subprocess.DEVNULL, check=True)
    seconds = time.monotonic() - begin
    print(f"{seconds:.3f} {resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1000:.0f}")


def mac(a, b):
    inner = sum(x.conjugate() * y for x, y in zip(a, b))
    return abs(inner) ** 2 / (sum(abs(x) ** 2 for x in a) * sum(abs(y) ** 2 for y in b))


def score(path, n):
    modes = json.load(open(path))["modes"]
    found, least, squares, count, beside = 0, 1.0, 0.0, 0, len(modes)
    for mode in range(MODES):
        near = [m for m in modes if abs(m["frequency_hz"] / frequency_hz(mode) - 1) < 0.02]
        if not near:
            continue
        best = min(near, key=lambda m: abs(m["frequency_hz"] - frequency_hz(mode)))
        found, beside = found + 1, beside - 1
        own = [complex(*best["shape"][f"p{c + 1}"]) for c in range(n)]
        truth = shape(mode, n)
        least = min(least, mac(own, truth))
        one = max(range(n), key=lambda c: abs(own[c]))
        stated = best.get("shape_std") or {}
        for c in range(n):
            sigma = stated.get(f"p{c + 1}")
            if sigma and c != one:
                squares += ((own[c].real - truth[c] / truth[one]) / sigma) ** 2
                count += 1
    rms = math.sqrt(squares / count) if count else math.nan
    print(f"{found} {beside} {least:.5f} {rms:.2f}")


def by_numpy(record, result):
    import numpy
    import scipy.linalg
    from scipy.io import loadmat

    held = loadmat(record)
    n = sum(1 for name in held if name.startswith("p"))
    value = numpy.stack([held[f"p{c + 1}"].ravel() for c in range(n)], 1)
    segment, rows, lags_used = 512, 40, 80
    references = numpy.linspace(0, n - 1, 6).round().astype(int)
    window = numpy.hanning(segment + 1)[:-1]
    sums, count = numpy.zeros((segment + 1, n, 6), complex), 0
    for first in range(0, len(value) - segment + 1, segment // 2):
        part = value[first : first + segment]
        spectrum = numpy.fft.rfft((part - part.mean(0)).T * window, 2 * segment)
        sums += (spectrum[:, None, :] * spectrum[references].conj()[None]).transpose(2, 0, 1)
        count += 1
    own = numpy.fft.irfft(numpy.abs(numpy.fft.rfft(window, 2 * segment)) ** 2)
    reach = 2 * rows + 2
    lag = numpy.arange(-reach, reach + 1)
    undivided = numpy.fft.irfft(sums, axis=0)[lag] / (count * own[0])
    scale = numpy.sqrt(undivided[reach, references, range(6)])
    inner = undivided[:, references] / (scale[:, None] * scale[None])
    divided = inner * (own[0] / own[lag])[:, None, None]

    def blocks(r, index):
        return r[index].transpose(0, 2, 1, 3).reshape(index.shape[0] * 6, index.shape[1] * 6)

    a, b = numpy.indices((rows, rows))
    ridge = 1e-6 * numpy.eye(6 * rows)
    future = scipy.linalg.cholesky(blocks(inner, reach + a - b) + ridge, lower=True)
    past = scipy.linalg.cholesky(blocks(inner, reach + b - a) + ridge, lower=True)

    def weighted(hankel):
        half = scipy.linalg.solve_triangular(future, hankel, lower=True)
        return scipy.linalg.solve_triangular(past, half.T, lower=True).T

    u, s, v = scipy.linalg.svd(weighted(blocks(divided, reach + 1 + a + b)))
    order = 2 * MODES
    root = numpy.sqrt(s[:order])
    system = (u[:, :order].T @ weighted(blocks(divided, reach + 2 + a + b)) @ v[:order].T) / root[:, None] / root
    entrance = ((root[:, None] * v[:order]) @ past.T)[:, :6]
    poles, vectors = numpy.linalg.eig(system)
    entered = numpy.linalg.solve(vectors, entrance.astype(complex))
    basis = numpy.stack([poles[:, None] ** k * entered for k in range(lags_used)], 1).reshape(order, lags_used * 6)
    right = undivided[reach + 1 : reach + 1 + lags_used] * (own[0] / own[1 : 1 + lags_used])[:, None, None] / scale
    shapes = scipy.linalg.lstsq(basis.T, right.transpose(1, 0, 2).reshape(n, lags_used * 6).T.astype(complex))[0].T
    modes = []
    for k in numpy.where(poles.imag > 0)[0]:
        column = shapes[:, k] / shapes[numpy.abs(shapes[:, k]).argmax(), k]
        modes.append({"frequency_hz": abs(numpy.log(poles[k])) * RATE_HZ / 2 / math.pi, "shape": {f"p{c + 1}": [z.real, z.imag] for c, z in enumerate(column)}})
    json.dump({"modes": modes}, open(result, "w"))


if __name__ == "__main__":
    verb = sys.argv[1]
    if verb == "make":
        make(int(sys.argv[2]), int(sys.argv[3]), sys.argv[4])
    elif verb == "run":
        run(sys.argv[2], sys.argv[3:])
    elif verb == "score":
        score(sys.argv[2], int(sys.argv[3]))
    elif verb == "numpy":
        by_numpy(sys.argv[2], sys.argv[3])
    else:
        sys.exit(__doc__)

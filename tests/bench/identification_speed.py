#!/usr/bin/env python3
"""The same update as `identification_speed run`, with NumPy and SciPy as one would write it: whole arrays, LAPACK.

    identification_speed.py DATA CHANNELS plain|cva BLOCK_ROWS REPEATS POLES [svd|gram]
    identification_speed.py compare POLES POLES         the worst relative difference of two lists of poles

`svd` (default) factorises the Hankel matrix by LAPACK's gesdd, `gram` takes the eigenvectors of its Gram matrix.
One BLAS thread: set OPENBLAS_NUM_THREADS=1. Prints the least CPU time of an update and the BLAS in use.
"""
import pathlib
import sys
import time

import numpy as np
import scipy.cluster.hierarchy
import scipy.linalg
import scipy.signal

SEGMENT, ORDERS, RATE_HZ, RIDGE = 1024, range(2, 61, 2), 30.0, 1e-6
N_FFT = 2 * SEGMENT
WINDOW = scipy.signal.get_window("hann", SEGMENT)
FAST = {"check_finite": False}


class Sums:
    """Cross-spectra of all pairs i <= j (plain ERA needs only those with a reference)."""

    def __init__(self, channels, references, weighted):
        self.channels = channels
        first, second = np.triu_indices(channels)
        if not weighted:
            wanted = np.isin(first, references) | np.isin(second, references) | (first == second)
            first, second = first[wanted], second[wanted]
        self.first, self.second = first, second
        self.sum = np.zeros((len(first), N_FFT // 2 + 1), complex)
        self.segments = 0
        self.window_correlation = np.fft.irfft(np.abs(np.fft.rfft(WINDOW, N_FFT)) ** 2)

    def add(self, segment):
        spectrum = np.fft.rfft((segment - segment.mean(axis=0)).T * WINDOW, N_FFT)
        self.sum += spectrum[self.first] * spectrum[self.second].conj()
        self.segments += 1

    def correlations(self, max_lag):
        """(divided, undivided), lag -max_lag .. max_lag x channel x channel, channels of unit variance."""
        lags = np.arange(-max_lag, max_lag + 1)
        both = np.fft.irfft(self.sum)[:, lags]
        undivided = both / (self.segments * self.window_correlation[0])
        at_zero = undivided[self.first == self.second][:, max_lag]
        scale = np.sqrt(at_zero)
        undivided /= (scale[self.first] * scale[self.second])[:, None]
        full = np.zeros((self.channels, self.channels, len(lags)))
        full[self.first, self.second] = undivided
        full[self.second, self.first] = undivided[:, ::-1]
        full = np.ascontiguousarray(full.transpose(2, 0, 1))
        ratio = self.window_correlation[0] / self.window_correlation[lags]
        return full * ratio[:, None, None], full, scale


def blocks(r, lags):
    """Block matrix with block (a, b) = r[lags[a, b]]."""
    n_a, n_b = lags.shape
    return r[lags].transpose(0, 2, 1, 3).reshape(n_a * r.shape[1], n_b * r.shape[2])


def left_vectors(h, order, factoriser):
    if factoriser == "svd":
        u, s, vt = scipy.linalg.svd(h, full_matrices=False, overwrite_a=True, **FAST)
        return u[:, :order], s[:order], vt[:order].T
    n = h.shape[1]
    w, v = scipy.linalg.eigh(h.T @ h, subset_by_index=[n - order, n - 1], **FAST)
    s, v = np.sqrt(w[::-1]), v[:, ::-1]
    return h @ v / s, s, v


def realise(correlations, references, max_lag, rows, weighted, factoriser):
    divided, undivided, scale = correlations
    channels = len(scale)
    a, b = np.indices((rows, rows))
    to_reference = divided[:, :, references]
    h0 = blocks(to_reference, max_lag + 1 + a + b)
    h1 = blocks(to_reference, max_lag + 2 + a + b)
    top = np.eye(channels)
    if weighted:
        future = blocks(undivided, max_lag + a - b)
        past = blocks(undivided[:, references][:, :, references], max_lag + b - a)
        lower = [scipy.linalg.cholesky(t + RIDGE * np.eye(len(t)), lower=True, overwrite_a=True, **FAST)
                 for t in (future, past)]

        def whiten(h):
            half = scipy.linalg.solve_triangular(lower[0], h, lower=True, overwrite_b=True, **FAST)
            return scipy.linalg.solve_triangular(lower[1], half.T, lower=True, **FAST).T

        h0, h1, top = whiten(h0), whiten(h1), lower[0][:channels, :channels]
    order = max(ORDERS)
    u, s, v = left_vectors(h0, order, factoriser)
    root = np.sqrt(s)
    return (u.T @ h1 @ v) / root[:, None] / root, scale[:, None] * (top @ u[:channels]) * root, s


def poles_of(a, c):
    lambdas, shapes, orders = [], [], []
    for order in ORDERS:
        w, v = scipy.linalg.eig(a[:order, :order], **FAST)
        upper = w.imag > 0
        lambdas.append(w[upper])
        shapes.append(c[:, :order] @ v[:, upper])
        orders.append(np.full(upper.sum(), order))
    return np.concatenate(lambdas), np.concatenate(shapes, axis=1), np.concatenate(orders)


def collinearity(shapes):
    xx, yy = (shapes.real ** 2).sum(axis=0), (shapes.imag ** 2).sum(axis=0)
    xy = (shapes.real * shapes.imag).sum(axis=0)
    return ((xx - yy) ** 2 + 4 * xy ** 2) / (xx + yy) ** 2


def clusters_of(lambdas, shapes):
    f = np.log(lambdas).imag
    unit = shapes / np.linalg.norm(shapes, axis=0)
    df = np.abs(f[:, None] - f) / (0.015 * 0.5 * (f[:, None] + f))
    distance = np.where(df >= 1, 2, df + (1 - np.abs(unit.conj().T @ unit) ** 2) / 0.3)
    condensed = distance[np.triu_indices(len(f), 1)]
    return scipy.cluster.hierarchy.fcluster(scipy.cluster.hierarchy.linkage(condensed, "average"), 1.0, "distance")


def update(sums, segment, references, rows, weighted, factoriser):
    sums.add(segment)
    max_lag = 2 * rows + 1
    a, c, s = realise(sums.correlations(max_lag), references, max_lag, rows, weighted, factoriser)
    lambdas, shapes, orders = poles_of(a, c)
    return lambdas, orders, collinearity(shapes), clusters_of(lambdas, shapes), s


def blas_in_use():
    mapped = {pathlib.Path(word).resolve().name for word in pathlib.Path("/proc/self/maps").read_text().split()}
    return " ".join(sorted(name for name in mapped if name.startswith(("libblas", "liblapack", "libopenblas"))))


def compare(paths):
    """Orders must hold as many poles each; every pole of the first list against the nearest of its order."""
    first, second = (np.loadtxt(path) for path in paths)
    if not np.array_equal(first[:, 0], second[:, 0]):
        sys.exit("the lists do not hold the same number of poles in every order")
    worst = 0.0
    for order in np.unique(first[:, 0]):
        a, b = (p[p[:, 0] == order] @ [0, 1, 1j, 0] for p in (first, second))
        worst = max(worst, np.max(np.abs(a[:, None] - b).min(axis=1) / np.abs(a)))
    print(f"{worst:.1e}\t{len(first)} poles")


def main():
    if sys.argv[1] == "compare":
        compare(sys.argv[2:4])
        return
    path, method, poles = sys.argv[1], sys.argv[3], sys.argv[6]
    channels, rows, repeats = int(sys.argv[2]), int(sys.argv[4]), int(sys.argv[5])
    factoriser = sys.argv[7] if len(sys.argv) > 7 else "svd"
    motion = np.fromfile(path).reshape(-1, channels)
    references = np.array([0, (channels - 1) // 2, channels - 1])
    weighted, hop = method == "cva", SEGMENT // 2
    start = Sums(channels, references, weighted)
    for k in range(15):
        start.add(motion[k * hop:k * hop + SEGMENT])
    kept = start.sum.copy()
    least = np.inf
    for _ in range(repeats):
        start.sum[:], start.segments = kept, 15
        t0 = time.process_time()
        segment = motion[15 * hop:15 * hop + SEGMENT]
        lambdas, orders, mpc, clusters, s = update(start, segment, references, rows, weighted, factoriser)
        least = min(least, time.process_time() - t0)
    np.savetxt(poles, np.column_stack([orders, lambdas.real, lambdas.imag, mpc]), fmt="%d %.17g %.17g %.17g")
    print(f"{1e3 * least:.3f} ms\t{len(lambdas)} poles\t{clusters.max()} clusters\t"
          f"singular value 60: {s[59]:.12g}\t{blas_in_use()}")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Welch cross-spectra by scipy.signal.csd, for welch_golden_test.cpp, in welch_golden.json beside this script.

    make_welch_golden.py            writes the file (made with numpy 1.24, scipy 1.10)
    make_welch_golden.py --check    recomputes it with the installed scipy and prints the worst relative deviation;
                                    exit code 1 beyond 1e-10

One-sided density, detrend = constant, zero-padded to the power of two >= 2 * segment. Pair (i, j) is
E[X_i conj(X_j)]; scipy's csd(x, y) is E[conj(X) Y], hence csd(x_j, x_i).
"""
import argparse
import json
import pathlib
import sys

import numpy as np
import scipy.signal

RATE_HZ = 25.0
SAMPLES = 300
PATH = pathlib.Path(__file__).with_name("welch_golden.json")
# Bins below it, of the pair's peak, are what rounding leaves of the mean: deviations are taken relative to at least it.
FLOOR = 1e-4
BAR = 1e-10


def channels():
    random = np.random.default_rng(20240607)
    white = random.standard_normal((2, SAMPLES))
    resonant = scipy.signal.lfilter([1.0], [1.0, -1.6, 0.95], white[0])
    return np.array([resonant + 3.0, np.roll(resonant, 2) * 0.4 + white[1] - 7.0])


def spectra(x, window, segment, overlap):
    n_fft = 1 << (2 * segment - 1).bit_length()
    pairs = []
    for i in range(len(x)):
        for j in range(i, len(x)):
            _, density = scipy.signal.csd(x[j], x[i], fs=RATE_HZ, window=window, nperseg=segment,
                                          noverlap=int(segment * overlap), nfft=n_fft, detrend="constant",
                                          return_onesided=True, scaling="density")
            density = np.asarray(density, dtype=complex)
            pairs.append({"re": density.real.tolist(), "im": density.imag.tolist()})
    return {"window": window, "segment": segment, "overlap": overlap, "n_fft": n_fft, "pairs": pairs}


def write():
    x = channels()
    cases = [spectra(x, window, 48, overlap) for window in ("hann", "hamming", "boxcar") for overlap in (0.0, 0.5, 0.75)]
    cases.append(spectra(x, "hann", 64, 0.5))
    cases += [spectra(x, window, segment, overlap)  # odd lengths
              for window, segment, overlap in (("hann", 45, 0.5), ("hamming", 33, 0.75), ("boxcar", 31, 0.5), ("hann", 37, 0.3))]
    golden = {"rate_hz": RATE_HZ, "channels": x.tolist(), "cases": cases}
    PATH.write_text(json.dumps(golden, separators=(",", ":")).replace('{"window"', '\n{"window"') + "\n")


def worst_deviation():
    golden = json.loads(PATH.read_text())
    x = np.array(golden["channels"])
    worst = 0.0
    for case in golden["cases"]:
        again = spectra(x, case["window"], case["segment"], case["overlap"])
        for old, new in zip(case["pairs"], again["pairs"]):
            old, new = (np.array(p["re"]) + 1j * np.array(p["im"]) for p in (old, new))
            worst = max(worst, np.max(np.abs(new - old) / np.maximum(np.abs(old), FLOOR * np.abs(old).max())))
    return worst, len(golden["cases"])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--check", action="store_true")
    if not parser.parse_args().check:
        write()
        return 0
    worst, n_cases = worst_deviation()
    print(f"scipy {scipy.__version__}: {n_cases} cases, worst relative deviation {worst:.1e}")
    return 0 if worst <= BAR else 1


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Writes welch_golden.json beside itself: Welch cross-spectra by scipy.signal.csd, for welch_golden_test.cpp.

One-sided density, detrend = constant, zero-padded to the power of two >= 2 * segment. Pair (i, j) is
E[X_i conj(X_j)]; scipy's csd(x, y) is E[conj(X) Y], hence csd(x_j, x_i). Made with numpy 1.24, scipy 1.10.
"""
import json
import pathlib

import numpy as np
import scipy.signal

RATE_HZ = 25.0
SAMPLES = 300


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


def main():
    x = channels()
    cases = [spectra(x, window, 48, overlap) for window in ("hann", "hamming", "boxcar") for overlap in (0.0, 0.5, 0.75)]
    cases.append(spectra(x, "hann", 64, 0.5))
    golden = {"rate_hz": RATE_HZ, "channels": x.tolist(), "cases": cases}
    path = pathlib.Path(__file__).with_name("welch_golden.json")
    path.write_text(json.dumps(golden, separators=(",", ":")).replace('{"window"', '\n{"window"') + "\n")


if __name__ == "__main__":
    main()

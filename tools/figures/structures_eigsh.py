#!/usr/bin/python3
"""SciPy's eigsh beside our solution of a large eigenproblem, on the core that this process runs on.

usage: structures_eigsh.py K.mtx M.mtx TABLE      TABLE: output of `hovermodal-validate structure-large`
Prints eigsh's seconds, ours, and the largest relative difference of frequencies.
"""
import math
import sys
import time

import scipy.io
from scipy.sparse.linalg import eigsh

k_path, m_path, table = sys.argv[1:]
with open(table, encoding="utf-8") as lines:
    ours = next(line for line in lines if line.startswith("eigen\t")).split("\t")[1:]
seconds, frequencies = float(ours[0]), [float(hz) for hz in ours[1:]]
k, m = (scipy.io.mmread(path).tocsc() for path in (k_path, m_path))
begin = time.perf_counter()
eigenvalues = eigsh(k, len(frequencies), m, sigma=0.0, which="LM", return_eigenvectors=True)[0]
taken = time.perf_counter() - begin
theirs = sorted(math.sqrt(value) / (2.0 * math.pi) for value in eigenvalues)
worst = max(abs(a - b) / b for a, b in zip(frequencies, theirs))
print(f"{taken:.2f} {seconds:.2f} {worst:.1e}")

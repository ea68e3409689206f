#!/usr/bin/env python3
"""One identification with standard deviations by pyOMA2 (https://github.com/dagghe/pyOMA2), which is no part of this project.

    identification_pyoma.py PYOMA2 DATA CHANNELS BLOCK_ROWS [ORDER]

PYOMA2: its folder; needs NumPy and SciPy. Covariance-driven SSI with three references, orders 2, 4 ... ORDER (60) and
the covariance of every pole by its 10 segments. Prints the CPU time, the number of poles with a standard deviation, and the
version. One BLAS thread: set OPENBLAS_NUM_THREADS=1.
"""
import importlib.util
import pathlib
import re
import sys
import time
import types

import numpy as np

RATE_HZ, N_BLOCKS = 30.0, 10


def load(folder):
    bars = types.ModuleType("tqdm")  # its progress bars
    bars.trange, bars.tqdm = range, lambda values, *_, **__: values
    sys.modules["tqdm"] = bars
    spec = importlib.util.spec_from_file_location("ssi", folder / "src/pyoma2/functions/ssi.py")
    ssi = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(ssi)
    return ssi


def main():
    folder, path, channels, rows = pathlib.Path(sys.argv[1]), sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
    order = int(sys.argv[5]) if len(sys.argv) > 5 else 60
    ssi = load(folder)
    motion = np.fromfile(path).reshape(-1, channels).T
    references = motion[[0, (channels - 1) // 2, channels - 1]]
    begin = time.process_time()
    hankel, scatter = ssi.build_hank(motion, references, rows, "cov", calc_unc=True, nb=N_BLOCKS)
    observability, a, c, _ = ssi.SSI_fast(hankel, rows, order, step=2)
    poles = ssi.SSI_poles(observability, a, c, order, 1.0 / RATE_HZ, step=2, calc_unc=True, H=hankel, T=scatter)
    seconds = time.process_time() - begin
    version = re.search(r'^version = "(.*)"', (folder / "pyproject.toml").read_text(), re.M)[1]
    print(f"{1e3 * seconds:.0f} ms\t{np.isfinite(poles[4]).sum()} poles\tpyOMA2 {version}")


if __name__ == "__main__":
    main()

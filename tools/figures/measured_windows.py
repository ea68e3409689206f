"""Measured and published records, each with its window as chosen and over a factor of eight: for trust_measured.sh.

    measured_windows.py setups HOVERMODAL DATA          five-storey frame: modes and sigmas of each set-up, and merged
    measured_windows.py windows HOVERMODAL DATA         every record by block rows and by segment: spread of each mode
    measured_windows.py rates HOVERMODAL DATA FOLDER    the published records at 10 and 100 times their rate

Prints tab-separated lines.
"""
import json
import math
import pathlib
import subprocess
import sys

PUBLISHED_HZ = [1.229, 1.436, 2.100, 4.017, 4.769, 6.683, 7.614, 9.664]
FACTORS = [8 ** ((k - 3) / 6) for k in range(7)]  # from 1 / sqrt(8) to sqrt(8)
SAME = 0.02  # relative: a mode with another window


def records(data):
    frame = ["--rate", "256", "--channels", "1", "2", "3", "4", "5", "--max-frequency", "12"]
    for setup in ("01", "04", "07", "10"):
        yield f"frame {setup}", [f"{data}/five_storey_frame/setup_{setup}.csv", *frame]
    yield "five", [f"{data}/five_dof_example/accelerations.csv", "--rate", "100", "--max-frequency", "10"]
    yield "shear", [f"{data}/published_shear_frame/accelerations.csv", "--quantity", "a", "--max-frequency", "2"]
    shake = f"{data}/mini_shake_table/flexible_northridge.csv"
    yield "shake", [shake, "--input", "ground_m_s2", "--max-frequency", "24"]
    yield "shake without input", [shake, "--max-frequency", "24"]


def identified(program, arguments):
    done = subprocess.run([program, "identify", "--series", *arguments, "--json", "--quiet"], stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL, check=False)
    return json.loads(done.stdout) if done.returncode == 0 and done.stdout else {"modes": []}


def nearest(modes, hz, within=SAME):
    best = min(modes, key=lambda mode: abs(mode["frequency_hz"] - hz), default=None)
    return best if best is not None and abs(best["frequency_hz"] - hz) < within * hz else None


def number(value):
    return "-" if value is None else f"{value:.6g}"


def setups(program, data):
    by_setup = {}
    for name, arguments in records(data):
        if not name.startswith("frame"):
            continue
        modes = [mode for mode in identified(program, arguments)["modes"] if mode["frequency_hz"] < 10]
        by_setup[name] = [nearest(modes, hz) for hz in PUBLISHED_HZ]
        found = [mode for mode in by_setup[name] if mode]
        stated = sum(mode["frequency_std_hz"] is not None and mode["damping_std"] is not None for mode in found)
        print(f"setup\t{name}\t{len(found)}\t{len(modes) - len(found)}\t{stated}")
    for which, sigma in (("frequency_hz", "frequency_std_hz"), ("damping_ratio", "damping_std")):
        squares = n = 0
        for modes in zip(*by_setup.values()):
            seen = [(mode[which], mode[sigma]) for mode in modes if mode and mode[sigma]]
            weight = sum(1 / s**2 for _, s in seen)
            mean = sum(value / s**2 for value, s in seen) / weight if seen else 0
            squares += sum(((value - mean) / s) ** 2 for value, s in seen)
            n += max(0, len(seen) - 1)
        print(f"scatter\t{which}\t{math.sqrt(squares / n) if n else math.nan:.3f}\t{n}")
    files = [f"{data}/five_storey_frame/setup_{setup}.csv" for setup in ("01", "04", "07", "10")]
    merged = identified(program, [*files, "--rate", "256", "--channels", "1", "2", "3", "4", "5", "--max-frequency", "12",
                                  "--reference", "ref_x_m_s2", "ref_y_m_s2", "--merge"])
    modes = [mode for mode in merged["modes"] if mode["frequency_hz"] < 10]
    found = [mode for mode in (nearest(modes, hz) for hz in PUBLISHED_HZ) if mode]
    stated = sum(mode["frequency_std_hz"] is not None and mode["damping_std"] is not None for mode in found)
    print(f"setup\tmerged\t{len(found)}\t{len(modes) - len(found)}\t{stated}")


def chosen_window(program, arguments):
    estimate = identified(program, arguments)
    if not estimate["modes"]:
        return estimate, 0, 0
    segment = round(estimate["rate_hz"] / estimate["resolution_hz"])
    n = sum(channel["takes_part"] for channel in estimate["channels"]) + ("--input" in arguments)
    rows = min(240, estimate["samples"] / 16)
    longest = 2 ** math.ceil(math.log2(2 * segment)) // 16
    return estimate, segment, max(6, min(int(rows / n), longest))


def windows(program, data):
    for name, arguments in records(data):
        estimate, segment, rows = chosen_window(program, arguments)
        for option, chosen in (("--block-rows", rows), ("--segment", segment)):
            tried = [identified(program, [*arguments, option, str(max(4, round(chosen * f)))])["modes"] for f in FACTORS]
            for mode in estimate["modes"]:
                found = [other for other in (nearest(modes, mode["frequency_hz"]) for modes in tried) if other]
                for which, sigma in (("frequency_hz", "frequency_std_hz"), ("damping_ratio", "damping_std")):
                    values = [other[which] for other in found] + [mode[which]]
                    spread = (max(values) - min(values)) / mode[sigma] if mode[sigma] else math.nan
                    print(f"window\t{name}\t{option[2:]}\t{mode['frequency_hz']:.4f}\t{which}\t{len(found)}\t"
                          f"{len(tried)}\t{spread:.3f}")


def rates(program, data, folder):
    import numpy
    from scipy.io import savemat
    from scipy.signal import resample_poly

    for name, rate_hz, path in (("five", 100.0, "five_dof_example"), ("shear", 12.0, "published_shear_frame")):
        text = pathlib.Path(data, path, "accelerations.csv").read_text().splitlines()
        rows = [line for line in text if line and line[0] in "-+.0123456789"]
        value = numpy.array([[float(cell) for cell in line.split(",")] for line in rows])
        header = next(line for line in text if not line.startswith("#") and line not in rows)
        names = [cell.strip() for cell in header.split(",")]
        keep = [c for c, cell in enumerate(names) if cell not in ("t_s", "time_s", "frame")]
        for factor in (1, 10, 100):
            finer = resample_poly(value[:, keep], factor, 1, axis=0) if factor > 1 else value[:, keep]
            mat = pathlib.Path(folder, f"{name}_{factor}.mat")
            savemat(mat, {"rate_hz": rate_hz * factor, **{f"a{c}": finer[:, c] for c in range(finer.shape[1])}})
            modes = identified(program, [str(mat), "--quantity", "a"])["modes"]
            print(f"rate\t{name}\t{factor}\t" + " ".join(f"{mode['frequency_hz']:.4f}" for mode in modes))
            mat.unlink()


if __name__ == "__main__":
    {"setups": setups, "windows": windows, "rates": rates}[sys.argv[1]](*sys.argv[2:])

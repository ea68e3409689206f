"""Converters: upstream files to the files that the tests and figures read. Each takes the folder of the upstream files, their paths in
it, and the file to write. Numbers are printed with a fixed number of digits, so that the result has one sha256 everywhere."""
import array
import ast
import csv
import json
import re
import shutil
import subprocess
import sys
import tempfile
import time

from table import KitError, files_below

class NoModule(KitError):
    def __init__(self, error):
        super().__init__(f"{error.name} is not installed: tools/setup.sh --data installs python3-numpy and python3-scipy")


EXPORTED = {}  # name in the table: converter


def converter(function):
    EXPORTED[function.__name__] = function
    return function


@converter
def copy(folder, paths, out):
    source = folder / paths[0]
    if not source.is_dir():
        shutil.copyfile(source, out)
        return
    for name in files_below(source):  # contents only: the permissions of folders are not copied
        (out / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source / name, out / name)


def read_npy(path):
    """Shape and numbers of a little-endian float64 array in C order (NumPy's format 1.0)."""
    data = path.read_bytes()
    if data[:8] != b"\x93NUMPY\x01\x00":
        raise KitError(f"{path.name}: not a file of NumPy's format 1.0")
    end = 10 + int.from_bytes(data[8:10], "little")
    header = ast.literal_eval(data[10:end].decode("latin-1"))
    if header["descr"] != "<f8" or header["fortran_order"]:
        raise KitError(f"{path.name}: {header['descr']} numbers, expected <f8 in C order")
    numbers = array.array("d", data[end:])
    if sys.byteorder == "big":
        numbers.byteswap()
    return header["shape"], numbers


def write_lines(out, lines):
    with open(out, "w", encoding="utf-8", newline="") as text:
        text.writelines(line + "\n" for line in lines)


@converter
def five_storey_npy(folder, paths, out):
    (rows, columns), numbers = read_npy(folder / paths[0])
    lines = (",".join(f"{v:.5g}" for v in numbers[i * columns:(i + 1) * columns]) for i in range(rows))
    write_lines(out, ["laser1_m_s,laser2_m_s,laser3_m_s,ref_x_m_s2,ref_y_m_s2,ref_z_m_s2", *lines])


@converter
def shear_frame_npy(folder, paths, out):
    rate_hz = 12
    (rows, columns), numbers = read_npy(folder / paths[0])
    lines = (f"{i / rate_hz:.6f}," + ",".join(f"{v:.6g}" for v in numbers[i * columns:(i + 1) * columns]) for i in range(rows))
    write_lines(out, ["t_s,top_floor,floor4,floor3,floor2,floor1", *lines])


@converter
def beam_npy(folder, paths, out):
    """points x frames x (vertical, horizontal), m; the vertical ones."""
    rate_hz = 15000
    (points, frames, axes), numbers = read_npy(folder / paths[0])
    lines = (f"{i / rate_hz:.7f}," + ",".join(f"{1e6 * numbers[(p * frames + i) * axes]:.4f}" for p in range(points)) for i in range(frames))
    write_lines(out, ["t_s," + ",".join(f"p{p}_um" for p in range(points)), *lines])


def read_logger(path):
    """(time in us, acceleration along x) of an Xsens DOT's file."""
    rows, columns = [], None
    for line in path.read_text(encoding="utf-8").splitlines():
        cells = line.split(",")
        if columns is None:
            columns = cells if cells[0] == "PacketCounter" else None
        elif line.strip():
            rows.append((int(cells[columns.index("SampleTimeFine")]), float(cells[columns.index("Acc_X")])))
    return rows


@converter
def logger_csv(folder, paths, out):
    write_lines(out, ["t_s,acc_x_m_s2", *(f"{t / 1e6:.6f},{a:.5f}" for t, a in read_logger(folder / paths[0]))])


@converter
def loggers_csv(folder, paths, out):
    """Four synchronised loggers, ground first: the times that all have."""
    logs = [dict(read_logger(folder / p)) for p in paths]
    times = sorted(set.intersection(*(set(log) for log in logs)))
    lines = (f"{(t - times[0]) / 1e6:.6f}," + ",".join(f"{log[t]:.5f}" for log in logs) for t in times)
    write_lines(out, ["t_s,ground_m_s2,floor1_m_s2,floor2_m_s2,floor3_m_s2", *lines])


@converter
def five_dof_generator(folder, paths, out):
    """Runs the one function of the upstream module that simulates (seeded inside); the module's other needs are not installed."""
    try:
        import numpy
        from scipy import linalg, signal
    except ImportError as error:
        raise NoModule(error) from error
    module = ast.parse((folder / paths[0]).read_text(encoding="utf-8"))
    module.body = [node for node in module.body if isinstance(node, ast.FunctionDef) and node.name == "example_data"]
    names = {"np": numpy, "linalg": linalg, "signal": signal}
    exec(compile(module, paths[0], "exec"), names)  # its sha256 is the table's
    rows = names["example_data"]()[0]
    write_lines(out, ["ch1_m_s2,ch2_m_s2,ch3_m_s2,ch4_m_s2,ch5_m_s2", *(",".join(f"{v:.9g}" for v in row) for row in rows)])


@converter
def lens_profiles(folder, paths, out):
    """A line a profile that states a readout time."""
    keys = ["camera_brand", "camera_model", "lens_model", "camera_setting"]
    with open(out, "w", encoding="utf-8", newline="") as text:
        table = csv.writer(text)
        table.writerow(keys + ["width", "height", "fps", "frame_readout_time_ms", "calibrated_by", "file"])
        for path in sorted(p.relative_to(folder).as_posix() for p in folder.glob(paths[0])):
            profile = json.loads((folder / path).read_text(encoding="utf-8"))
            if not profile.get("frame_readout_time"):
                continue
            size = profile["calib_dimension"]
            table.writerow([profile[k] for k in keys] + [size["w"], size["h"], profile["fps"], profile["frame_readout_time"],
                                                         profile["calibrated_by"], path])


EXACT = "scale=flags=accurate_rnd+bitexact"  # the same gray levels on every processor
GRAY = f"{EXACT},format=gray,{EXACT}:out_range=tv,format=yuv420p"


def run_ffmpeg(words, n_frames):
    """With a line of progress every ten seconds."""
    with tempfile.TemporaryFile("w+") as errors:
        try:
            child = subprocess.Popen(["ffmpeg", "-hide_banner", "-loglevel", "error", "-nostats", "-progress", "pipe:1", "-y", *words],
                                     stdout=subprocess.PIPE, stderr=errors, text=True)
        except FileNotFoundError as error:
            raise KitError("ffmpeg is not installed: tools/setup.sh installs it") from error
        said = time.monotonic()
        for line in child.stdout:
            m = re.fullmatch(r"frame=\s*(\d+)\s*", line)
            if m and time.monotonic() - said > 10:
                said = time.monotonic()
                print(f"  {m.group(1)} of {n_frames} frames", flush=True)
        if child.wait() != 0:
            errors.seek(0)
            raise KitError(f"ffmpeg ended with {child.returncode}: {errors.read().strip()}")


@converter
def frame_video(folder, paths, out):
    """The photographs in order, gray, 20 a second. Three threads, whatever the machine: their number changes the encoded bytes."""
    photographs = folder / paths[0]
    n_frames = len(list(photographs.iterdir()))
    print(f"  encoding {n_frames} frames, about two minutes", flush=True)
    run_ffmpeg(["-framerate", "20", "-i", str(photographs / "IMG%05d.jpg"), "-vf", GRAY,
                "-c:v", "libx264", "-crf", "17", "-g", "30", "-threads", "3", "-fflags", "+bitexact", "-f", "mp4", str(out)], n_frames)


def compare_video(folder, paths, out):
    """How far the worst frame of a video is from its photograph, gray levels rms; None where not every photograph has its frame."""
    photographs = folder / paths[0]
    n_frames = len(list(photographs.iterdir()))
    with tempfile.NamedTemporaryFile("r") as log:
        run_ffmpeg(["-framerate", "20", "-i", str(photographs / "IMG%05d.jpg"), "-i", str(out), "-lavfi",
                    f"[0:v]{GRAY}[a];[1:v]setpts=N/20/TB[b];[a][b]psnr=shortest=1:stats_file={log.name}", "-f", "null", "-"], n_frames)
        errors = [float(e) for e in re.findall(r"mse_y:([0-9.]+)", log.read())]
    return max(errors) ** 0.5 if len(errors) == n_frames else None


# Converters whose bytes depend on the version of a program: another result is accepted if compare gives at most this.
COMPARED = {"frame_video": (compare_video, 2.0, "gray levels rms from the photographs, worst frame")}


@converter
def dot_centroids(folder, paths, out):
    try:
        import dots
    except ImportError as error:
        raise NoModule(error) from error
    print("  finding the dots of the photographs, about a minute", flush=True)
    names = ",".join(f"t{t:02}_x,t{t:02}_y" for t in range(len(dots.ROWS_V) * dots.PER_ROW))
    write_lines(out, ["frame," + names, *dots.centroids(folder / paths[0])])

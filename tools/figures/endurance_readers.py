#!/usr/bin/env python3
"""Peak memory of every reader on its worst input: the largest that is admitted, and one that is over the bound.
    endurance_readers.py BIN FOLDER [READER...]
Each call is one process, BIN/reader_peak KIND FILE. Prints "reader<TAB>admitted|refused<TAB>MB<TAB>exit code<TAB>words";
MB is ru_maxrss of the whole process. Files are written to FOLDER one after the other and deleted."""
import os
import re
import shutil
import struct
import subprocess
import sys
import zlib
from pathlib import Path

LAUNCHER = """import os, sys
pid = os.fork()
if pid == 0:
    log = os.open(sys.argv[1], os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
    os.dup2(log, 1), os.dup2(log, 2)
    os.execv(sys.argv[2], sys.argv[2:])
_, status, usage = os.wait4(pid, 0)
print(usage.ru_maxrss, os.waitstatus_to_exitcode(status))"""
LIMITS = {}
TRACKS_HEAD = "# image_size_px: 480 x 270\n# rate_hz: 25\nframe,t_s,point,region,u_px,v_px,sigma_px\n"


def read_limits(root):
    text = (root / "drivers/storage/limits.h").read_text(encoding="utf-8")
    LIMITS.update(kKiB=1 << 10, kMiB=1 << 20)
    version = re.search(r"kCheckpointVersion = (\d+)", (root / "drivers/storage/checkpoint_file.h").read_text(encoding="utf-8"))
    LIMITS["kCheckpointVersion"] = int(version.group(1))
    for name, header in (("kDecoderMb", "camera_kind.h"), ("kBesideOfMotion", "recording/decoder_memory.cpp")):
        LIMITS[name] = float(re.search(name + r" = ([\d.]+)", (root / "drivers/camera" / header).read_text(encoding="utf-8")).group(1))
    for name, value in re.findall(r"constexpr std::\w+ (k\w+) =\s+([^;,]+);", text):
        value = re.sub(r"\b(\d+)U\b", r"\1", value.replace("'", ""))
        LIMITS[name] = eval(value, {}, LIMITS)  # constants of our own header


def lines_to(path, head, line, n):
    with open(path, "w", encoding="utf-8") as out:
        out.write(head)
        for begin in range(0, n, 100000):
            out.write("".join(map(line, range(begin, min(n, begin + 100000)))))


def png(path, width, height, bits, colour):
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    packer, row = zlib.compressobj(1), bytes(1 + width * {0: 1, 2: 3, 6: 4}[colour] * bits // 8)
    pixels = b"".join(packer.compress(row) for _ in range(height)) + packer.flush()
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, bits, colour, 0, 0, 0)) +
                     chunk(b"IDAT", pixels) + chunk(b"IEND", b""))


def side_of_pictures(n):
    """Of the largest square pictures of which a decoder may hold n (drivers/camera/recording/decoder_memory.cpp)."""
    one = LIMITS["kDecoderMb"] * 1e6 / n / 1.5 / (1 + LIMITS["kBesideOfMotion"])
    return int(one ** 0.5) // 128 * 128


def clip(path, side, codec, *options):
    subprocess.run(["ffmpeg", "-v", "error", "-f", "lavfi", "-i", f"color=gray:s={side}x{side}:r=25", "-frames:v", "20", "-c:v", codec, *options, "-pix_fmt", "yuvj420p" if codec == "mjpeg" else "yuv420p", "-f", "matroska" if codec == "mjpeg" else "mp4", "-y", path], check=True)
    return "video"


def jpeg(path, width, height, progressive):
    """Heads of a colour image without subsampling, and of its first scan; the rest is missing, which libjpeg fills."""
    def segment(mark, data):
        return bytes((0xFF, mark)) + struct.pack(">H", len(data) + 2) + data
    parts = b"".join(bytes((c, 0x11, 0)) for c in (1, 2, 3))
    table = bytes((1,)) + bytes(15) + bytes((0,))  # one code of one bit: the value 0
    scan = bytes((3, 1, 0, 2, 0, 3, 0)) + bytes((0, 0 if progressive else 63, 0))
    path.write_bytes(b"\xFF\xD8" + segment(0xDB, bytes((0,)) + bytes([1] * 64)) +
                     segment(0xC2 if progressive else 0xC0, bytes((8,)) + struct.pack(">HHB", height, width, 3) + parts) +
                     segment(0xC4, bytes((0x00,)) + table) + segment(0xC4, bytes((0x10,)) + table) + segment(0xDA, scan) + bytes(100000) + b"\xFF\xD9")


class Readers:
    """Each method writes its file for over = 0 (the worst that is admitted) or 1 (beyond) and returns the kind of reader_peak; None: there is no such input."""

    def timestamps(self, path, over):
        lines_to(path, "frame,t_s\n", lambda i: f"{i},{i // 25}.{i % 25 * 4:02}\n", LIMITS["kTimestamps"] - 2 + 2 * over)
        return "timestamps"

    def subtitles(self, path, over):
        block = ("FrameCnt: {} [shutter : 1/800.0] [focal_len : 240] [dzoom_ratio: 10000] [gb_yaw: 1.0 gb_pitch: 2.0 gb_roll: 3.0]\n\n")
        lines_to(path, "", lambda i: f"{i + 1}\n{i // 216000:02}:{i // 3600 % 60:02}:{i // 60 % 60:02},{i % 60 * 16:03} --> "
                 f"{i // 216000:02}:{i // 3600 % 60:02}:{i // 60 % 60:02},{i % 60 * 16 + 16:03}\n" + block.format(i + 1), LIMITS["kSubtitleBlocks"] + over)
        return "telemetry"

    def raw_telemetry(self, path, over):
        gyro = b"GYRO" + struct.pack(">ccH", b"s", b"\x06", 200) + bytes(1200)
        stream = b"STRM" + struct.pack(">ccH", b"\0", b"\x01", 16 + len(gyro)) + b"SCAL" + struct.pack(">ccHhh", b"s", b"\x02", 1, 100, 0) + gyro + bytes(4)
        device = b"DEVC" + struct.pack(">ccH", b"\0", b"\x01", len(stream)) + stream
        path.write_bytes(device * (LIMITS["kRawTelemetryBytes"] // len(device) + over))
        return "telemetry"

    def attitude(self, path, over):
        lines_to(path, "t_s,roll_deg,pitch_deg,yaw_deg\n", lambda i: f"{i // 200}.{i % 200 * 5:03},1,1,1\n", LIMITS["kAttitudes"] - 2 + 2 * over)
        return "attitude"

    def table(self, path, over, columns):
        head = "t_s," + ",".join(f"c{i}" for i in range(columns - 1)) + "\n" if columns > 1 else "c\n"
        tail = "," + ",".join("1" for _ in range(columns - 1)) + "\n" if columns > 1 else "\n"
        lines_to(path, head, lambda i: f"{i}e-2{tail}", LIMITS["kSeriesCells"] // columns - 2 + 3 * over)

    def series(self, path, over):
        self.table(path, over, 8)
        return "series"

    def series_of_one(self, path, over):
        self.table(path, over, 1)
        return "series"

    def series_wide(self, path, over):
        self.table(path, over, 4096)
        return "series"

    def foreign(self, path, over):
        self.table(path, over, 8)
        return "foreign"

    def comments(self, path, over):
        n = LIMITS["kCommentBytes"] // 17 - 1 + 2 * over
        lines_to(path, "", lambda i: f"# k{i:07}: {i:08}\n", n)
        with open(path, "a", encoding="utf-8") as out:
            out.write("t_s,a\n0,1\n1,1\n")
        return "series"

    def flight_log(self, path, over):
        lines_to(path, "t_s,roll,pitch,yaw,u,v,w\n", lambda i: f"{i}e-3,1,1,1,1,1,1\n" if over == 0 else f"{i * 9}e-4,1,1,1,1,1,1\n", LIMITS["kFlightLogRows"] + 100 * over)
        return "flight_log"

    def points(self, path, over):
        n = LIMITS["kPointsPerFrame"] + over
        lines_to(path, TRACKS_HEAD, lambda i: f"0,0,{i},r{i % 32},1,1,0.1\n", n)
        return "tracks"

    def points_of_a_run(self, path, over):
        n = LIMITS["kTrackedPoints"] + over
        lines_to(path, TRACKS_HEAD, lambda i: f"{i // 300},{i // 300 // 25}.{i // 300 % 25 * 4:02},{i},base,1,1,0.1\n", n)
        return "tracks"

    def tracks_30_min(self, path, over):
        """A flight of 30 min at 25 fps with 300 points: no bound, one frame at a time."""
        if over:
            return None
        lines_to(path, TRACKS_HEAD, lambda i: f"{i // 300},{i // 300 // 25}.{i // 300 % 25 * 4:02},{i % 300},base,101.2345,98.7654,0.02\n", 300 * 25 * 1800)
        return "tracks"

    def image_gray(self, path, over):
        side = int(LIMITS["kImagePixels"] ** 0.5)
        png(path, side, side + over, 8, 0)
        return "image"

    def image_colour(self, path, over):
        side = int(LIMITS["kImagePixels"] ** 0.5)
        png(path, side, side, 8, 6 if over else 2)  # with alpha it is beyond
        return "image"

    def image_jpeg(self, path, over):
        side = int(LIMITS["kImagePixels"] ** 0.5)
        jpeg(path, side, side + 8 * over, False)
        return "image"

    def image_jpeg_progressive(self, path, over):
        """Six bytes a pixel are kept by libjpeg."""
        side = int((LIMITS["kJpegBytes"] / 6) ** 0.5) // 64 * 64
        jpeg(path, side + 128 * over, side + 128 * over, True)
        return "image"

    def video(self, path, over):
        """H.264 with as many reference pictures as there can be; beyond: the largest pictures with them."""
        side = int(LIMITS["kImagePixels"] ** 0.5) if over else side_of_pictures(17)
        return clip(path, side, "libx264", "-preset", "ultrafast", "-x264-params", "ref=16:keyint=100:bframes=0")

    def video_larger(self, path, over):
        """The same, and the next size."""
        return clip(path, side_of_pictures(17) + 128 * over, "libx264", "-preset", "ultrafast", "-x264-params", "ref=16:keyint=100:bframes=0")

    def video_largest(self, path, over):
        """H.264 with one reference picture, as large as that can be."""
        return clip(path, side_of_pictures(2) + 128 * over, "libx264", "-preset", "ultrafast", "-x264-params", "ref=1:keyint=100:bframes=0")

    def video_of_jpeg(self, path, over):
        side = int(LIMITS["kImagePixels"] ** 0.5)
        return clip(path, side + 16 * over, "mjpeg", "-q:v", "5")

    def video_hevc(self, path, over):
        """HEVC announces no number of reference pictures: those held are counted."""
        return clip(path, side_of_pictures(6 if over else 12), "libx265", "-preset", "ultrafast", "-x265-params", "ref=8:keyint=100:bframes=0:log-level=none")

    def event(self, path, over):
        n = LIMITS["kRecordEventBytes"] + over
        with open(path, "wb") as out:
            out.write(bytes.fromhex("eda1da01") + bytes(16) + struct.pack(">II", 1, n) + b"C")
            out.truncate(29 + n)
        return "events"

    def record(self, path, over):
        """An event of the greatest length on the channel of a run's head."""
        n, channel = LIMITS["kRecordEventBytes"] + over, b"HOVERMODAL_RUN"
        with open(path, "wb") as out:
            out.write(bytes.fromhex("eda1da01") + bytes(16) + struct.pack(">II", len(channel), n) + channel)
            out.truncate(28 + len(channel) + n)
        return "record"

    def calibration(self, path, over):
        n = LIMITS["kCalibrationBytes"] - 100 + 200 * over
        head = ("%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\ncamera_matrix: {rows: 3, cols: 3, data: [500, 0, 320, 0, 500, 240, 0, 0, 1]}\n"
                "distortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}\npoints: [")
        nodes = 290000
        number = "1" * ((n - len(head)) // nodes - 1)
        text = head + f"{number}," * (nodes - 1) + number + "]"
        path.write_text(text + " " * (n - len(text) - 1) + "\n", encoding="utf-8")
        return "calibration"

    def configuration(self, path, over):
        text = "regions: [" + "{name: a}," * 30000 + "{name: a}]\n"
        path.write_text(text + "#" * (LIMITS["kYamlBytes"] - len(text) + over - 1) + "\n", encoding="utf-8")
        return "configuration"

    def scene(self, path, over):
        text = "structure: [" + "[]," * 90000 + "[]]\n"
        path.write_text(text + "#" * (LIMITS["kYamlBytes"] - len(text) + over - 1) + "\n", encoding="utf-8")
        return "scene"

    def structure(self, path, over):
        text = "structure: [" + "[]," * 90000 + "[]]\n"
        path.write_text(text + "#" * (LIMITS["kYamlBytes"] - len(text) + over - 1) + "\n", encoding="utf-8")
        return "structure"

    def result(self, path, over):
        n = LIMITS["kJsonBytes"] // 3 - 10 + 20 * over
        path.write_text('{"modes":[' + "[]," * n + "[]]}", encoding="utf-8")
        return "result"

    def result_of_objects(self, path, over):
        n = LIMITS["kJsonBytes"] // 8 - 10 + 20 * over
        path.write_text('{"modes":[' + '{"a":1},' * n + "{}]}", encoding="utf-8")
        return "result"

    def state(self, path, over):
        n = LIMITS["kStateBytes"] + over
        with open(path, "wb") as out:
            out.write(b"HMSTATE\n" + struct.pack("<IIQQ", LIMITS["kCheckpointVersion"], 0, n, 0))
            out.truncate(32 + n)
        return "state"


def peak(command, log):
    """By a small process of its own: a child's peak counts that of the process that started it."""
    text = subprocess.run([sys.executable, "-S", "-c", LAUNCHER, log, *map(str, command)], check=True, capture_output=True, text=True).stdout
    kib, code = text.split()
    return int(kib) * 1024 / 1e6, int(code)


def main():
    program, folder = Path(sys.argv[1]).resolve() / "reader_peak", Path(sys.argv[2]).resolve()
    read_limits(Path(__file__).resolve().parents[2])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    suffixes = {"subtitles": ".SRT", "raw_telemetry": ".gpmf", "image_gray": ".png", "image_colour": ".png", "image_jpeg": ".jpg",
                "image_jpeg_progressive": ".jpg", "video": ".mp4", "video_larger": ".mp4", "video_largest": ".mp4", "video_of_jpeg": ".mkv", "video_hevc": ".mp4", "record": "_run0001_000.lcm"}
    names = [name for name in vars(Readers) if not name.startswith("_") and name != "table"]
    for name in sys.argv[3:] or names:
        for over in (0, 1):
            path = folder / (name + suffixes.get(name, ".csv"))
            kind = getattr(Readers(), name)(path, over)
            if kind is None:
                continue
            mb, code = peak([program, kind, path], folder / "log")
            words = (folder / "log").read_text(encoding="utf-8", errors="replace").strip().splitlines()
            print(name, "refused" if over else "admitted", f"{mb:.0f}", code, (words or [""])[-1].replace(str(folder) + "/", "")[-200:], sep="\t", flush=True)
            path.unlink()


if __name__ == "__main__":
    main()

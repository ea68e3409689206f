#!/usr/bin/env python3
"""Every place in the sources that opens a file has a bound: one of drivers/storage/limits.h in the file that is named beside it, or the reason why it
needs none. A new open, or one that has lost its bound, fails."""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
OPENS = re.compile(r"open_regular_file\(|read_text_file\(|read_json_file\(|read_checkpoint\(|CsvLines [a-z_]+[({]|CsvLines lines_;|CsvLines in_;|"
                   r"EventLogReader [a-z_]+[({;]|EventLogReader> |std::[io]?fstream [a-z_]+[({;]|[^_a-zA-Z.>]open(at)?\(|\bf(d)?open\(|"
                   r"avformat_open_input\(|imread\(path|mmap\(|directory_iterator\(")
NO_OPEN = re.compile(r"^\s*(//|\*)|std::optional<Message> |\.open\(\)|> open\(|\bopen\(\) const|: open\(\)|= open\(\)|\bopen\(\)\.|int open\(|"
                     r"open\(mark|void open\(|std::size_t open\(|::open\(Topic|V4l2Device::open\(const|MavlinkLink::open\(|opens? \(|gate_\.open|void load|\[\[nodiscard\]\] |"
                     r"= open\((key|list)|, open\(\), ")

# File -> what bounds each of its opens: NAME of Limits with the file that applies it, or words in capitals.
PROC, DEVICE, OUT, LIST = "A FILE OF THE KERNEL", "A DEVICE", "WRITTEN", "NAMES OF A FOLDER"
BOUNDS = {
    "drivers/camera/camera_list.cpp": [LIST],
    "drivers/camera/device/gone_nodes.cpp": [LIST, DEVICE],
    "drivers/camera/device/libcamera_session.cpp": [DEVICE],
    "drivers/camera/device/v4l2_device.cpp": [PROC, DEVICE, DEVICE],
    "drivers/camera/recording/clip_telemetry.cpp": ["kRawTelemetryBytes"],
    "drivers/camera/recording/container.cpp": ["kImagePixels drivers/camera/recording/video_decoder.cpp",
                                               "kImagePixels drivers/camera/recording/video_decoder.cpp"],
    "drivers/camera/recording/image_folder_source.cpp": [LIST],
    "drivers/camera/recording/srt_file.cpp": ["kSubtitleBytes", "kSubtitleBlocks", "kSubtitleBytes"],
    "drivers/camera/recording/timestamp_file.cpp": ["kTimestamps"],
    "drivers/exchange/mat_layout.cpp": ["kExchangeBytes"],
    "drivers/exchange/mat_writer.cpp": [OUT],
    "drivers/exchange/series_file.cpp": ["128 BYTES OF ITS HEAD"],
    "drivers/exchange/uff_functions.cpp": ["kExchangeBytes"],
    "drivers/host/host_status.cpp": [PROC, PROC],
    "drivers/host/memory_left.cpp": [PROC, PROC, PROC, PROC],
    "drivers/host/system_value.cpp": [PROC],
    "drivers/images/image_reader.cpp": ["kImagePixels", "kImagePixels"],
    "drivers/mavlink/mavlink_link.cpp": [DEVICE],
    "drivers/storage/attitude_file.cpp": ["kAttitudes"],
    "drivers/storage/calibration_file.cpp": ["kCalibrationBytes"],
    "drivers/storage/checkpoint_file.cpp": [OUT, "kStateBytes drivers/storage/checkpoint_file.h", "kStateBytes drivers/storage/checkpoint_file.h", PROC],
    "drivers/storage/csv_lines.cpp": ["kLineBytes drivers/storage/csv_lines.h", "kLineBytes drivers/storage/csv_lines.h"],
    "drivers/storage/csv_series.cpp": ["kSeriesCells drivers/storage/series_room.cpp"],
    "drivers/storage/folder_claim.cpp": [PROC, PROC, LIST],
    "drivers/storage/foreign_series.cpp": ["kSeriesCells drivers/storage/series_room.cpp"],
    "drivers/storage/json.cpp": ["kJsonBytes drivers/storage/json.h", "kJsonBytes drivers/storage/json.h"],
    "drivers/storage/partial_file.cpp": [OUT],
    "drivers/storage/regular_file.cpp": ["GIVEN BY EVERY CALLER", "GIVEN BY EVERY CALLER", "GIVEN BY EVERY CALLER"],
    "drivers/storage/scratch_file.cpp": [OUT],
    "drivers/storage/scene/reader.cpp": ["kYamlBytes drivers/storage/yaml.h"],
    "drivers/storage/matrix_market.cpp": ["kMatrixBytes"],
    "drivers/storage/motors_file.cpp": ["kAttitudes"],
    "drivers/storage/structure_file.cpp": ["kYamlBytes"],
    "drivers/storage/text_file.cpp": ["GIVEN BY EVERY CALLER", "GIVEN BY EVERY CALLER"],
    "drivers/storage/timed_columns.cpp": ["kFlightLogRows", "kFlightLogRows"],
    "drivers/storage/tracks_file.cpp": ["kTrackedPoints"],
    "drivers/storage/yaml.cpp": ["kYamlBytes drivers/storage/yaml.h"],
    "drivers/telemetry/event_log.cpp": [OUT],
    "drivers/telemetry/event_log_reader.cpp": ["kRecordEventBytes"],
    "drivers/telemetry/lcm_diagnosis.cpp": [PROC],
    "drivers/telemetry/log_player.h": ["kRecordEventBytes drivers/telemetry/event_log_reader.cpp"],
    "drivers/telemetry/record_folder.cpp": [LIST, LIST],
    "drivers/telemetry/run_record_reader.cpp": ["kRecordEventBytes drivers/telemetry/event_log_reader.cpp"],
    "firmware_app/chain/state/run_head.cpp": ["NAMEDFILE::KMOSTBYTES OF THE RECORD'S FORMAT"],
    "firmware_app/config/config.cpp": ["kYamlBytes drivers/storage/yaml.h"],
    "firmware_app/report/earlier_files.cpp": [LIST],
    "firmware_app/report/modal_json_reader.cpp": ["kJsonBytes drivers/storage/json.h"],
    "firmware_app/report/report_folder.cpp": [LIST, LIST, OUT],
    "firmware_app/report/structure_section.cpp": ["kPageBytes"],
    "firmware_app/service/kept_keyframe.cpp": ["SIZE OF THE CAMERA'S IMAGE"],
    "firmware_app/service/kept_state.cpp": ["SIZE OF THE RUN'S OWN STATE"],
    "tools/hovermodal/batch/combine.cpp": ["kStateBytes drivers/storage/checkpoint_file.h"],
    "tools/hovermodal/batch/inventory.cpp": [LIST],
    "tools/hovermodal/batch/mpi_workers.cpp": ["A MESSAGE OF MPI", "A MESSAGE OF MPI"],
    "tools/hovermodal/batch/workers.cpp": ["A LOG OF OUR OWN"],
    "tools/hovermodal/changes/flight_list.cpp": ["kFlights", "kFlights"],
    "tools/hovermodal/closeloop/closeloop_tracks.cpp": ["kLineBytes drivers/storage/csv_lines.h"],
    "tools/hovermodal/compare/seen_time.cpp": ["kLineBytes drivers/storage/csv_lines.h"],
    "tools/hovermodal/export/keyframe_places.cpp": ["kLineBytes drivers/storage/csv_lines.h"],
    "tools/hovermodal/inspect/telemetry.cpp": [OUT],
    "tools/hovermodal/readout/gyro_clip.cpp": ["kGyroRows"],
    "tools/hovermodal/simulate/truth.cpp": ["kJsonBytes drivers/storage/json.h"],
    "tools/hovermodal/spy/session.cpp": [OUT],
}


def opens():
    """Lines that open a file, by source."""
    found = {}
    for room in ("core", "drivers", "firmware_app", "rt", "tools/hovermodal", "tools/ground"):
        for path in sorted((ROOT / room).rglob("*")):
            if path.suffix not in (".cpp", ".h"):
                continue
            lines = path.read_text(encoding="utf-8").splitlines()
            hits = [(n, line) for n, line in enumerate(lines, 1) if OPENS.search(line) and not NO_OPEN.search(line)]
            if hits:
                found[str(path.relative_to(ROOT))] = hits
    return found


def main():
    limits = set(re.findall(r"constexpr std::\S+ (k\w+) =", (ROOT / "drivers/storage/limits.h").read_text(encoding="utf-8")))
    used, faults, found = set(), [], opens()
    for source, hits in found.items():
        bounds = BOUNDS.get(source, [])
        if len(hits) != len(bounds):
            faults += [f"{source}:{n}: {len(hits)} opens, {len(bounds)} bounds in {Path(__file__).name}: {line.strip()}" for n, line in hits]
        for bound in bounds:
            name, _, where = bound.partition(" ")
            if bound.isupper():
                continue
            used.add(name)
            if name not in limits or not re.search(rf"\b(Limits::)?{name}\b", (ROOT / (where or source)).read_text(encoding="utf-8")):
                faults.append(f"{source}: Limits::{name} is not applied in {where or source}")
    faults += [f"{source}: opens nothing any more" for source in BOUNDS if source not in found]
    print("\n".join(faults) or f"{sum(map(len, found.values()))} opens in {len(found)} sources have their bound, by {len(used)} limits or a reason")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/types/attitude.h"
#include "drivers/camera/recording/gpmf.h"
#include "drivers/camera/recording/srt_file.h"

namespace drivers {

struct TimedValue {
  double t_s = 0.0;  // in the video
  double value = 0.0;
};

// Telemetry that a camera wrote beside or in a video. Fields that it did not write are empty.
struct ClipTelemetry {
  std::string from;                    // "flight.SRT", "GPMF of GoPro Max"; empty: none found
  std::string trouble;                 // why telemetry that was found is not readable
  std::vector<std::int64_t> times_ns;  // of every frame by the camera's clock, from 0; empty: not for every frame
  double tick_s = 0.0;                 // their resolution
  std::vector<TimedValue> clock_s;     // the camera's clock at positions in the video
  double frame_rate_hz = 0.0;          // by the camera's clock; 0 = not stated
  double frame_jitter_s = 0.0;         // rms deviation of the clock's readings from that rate
  std::vector<TimedValue> exposure_s, focal_length, zoom, readout_s;
  std::vector<core::AttitudeSample> attitude;  // on the video's clock
  std::string attitude_from;                   // "gimbal", "gyro"

  [[nodiscard]] bool found() const noexcept { return !from.empty(); }
};

// One payload of a GPMF stream and its position in the video.
struct TimedPayload {
  double t_s = 0.0, duration_s = 0.0;  // duration 0: unknown
  GpmfPayload payload;
};

[[nodiscard]] ClipTelemetry telemetry_of(const SrtFile& file, const std::string& name);
// Rates of the gyro are integrated to attitudes in the axes that the camera states: X, Y, Z of ORIO (for cameras that
// state none, columns Z, X, Y), so that camera.mount_rpy_deg describes their orientation relative to the lens.
[[nodiscard]] ClipTelemetry telemetry_of(std::span<const TimedPayload> payloads);

// Searches beside and in the video: an SRT file of its name, otherwise a GPMF stream. Faulty content does not throw:
// see `trouble`.
// may_hold_gpmf: false if the container is known to have no such stream, which then is not opened.
[[nodiscard]] ClipTelemetry find_telemetry(const std::string& video, bool may_hold_gpmf = true);
// Reads an .SRT file, GPMF bytes (.raw, .gpmf) or a video. Throws std::runtime_error if there is no telemetry.
[[nodiscard]] ClipTelemetry read_telemetry(const std::string& file);

// Describes what was found, one statement each; the times of frames are described by the clock of frames.
[[nodiscard]] std::vector<std::string> telemetry_words(const ClipTelemetry& telemetry);

// Throws std::runtime_error where focal length or digital zoom changes by more than tracking can follow.
void refuse_zoom(const std::string& video, const ClipTelemetry& telemetry);

}  // namespace drivers

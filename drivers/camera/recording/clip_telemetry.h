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

// What a camera wrote of itself beside or in a video. What it did not write is empty.
struct ClipTelemetry {
  std::string from;                     // "flight.SRT", "GPMF of GoPro Max"; empty: none found
  std::string trouble;                  // found, but not readable: why
  std::vector<std::int64_t> times_ns;   // of every frame by the camera's clock, from 0; empty: not for every frame
  double tick_s = 0.0;                  // their resolution
  std::vector<TimedValue> clock_s;      // the camera's clock at places of the video
  double frame_rate_hz = 0.0;           // by the camera's clock; 0 = not stated
  double frame_jitter_s = 0.0;          // rms of the clock's readings about that rate
  std::vector<TimedValue> exposure_s, focal_length, zoom, readout_s;
  std::vector<core::AttitudeSample> attitude;  // on the video's clock
  std::string attitude_from;                   // "gimbal", "gyro"

  [[nodiscard]] bool found() const noexcept { return !from.empty(); }
};

// One payload of a GPMF stream and where it lies in the video.
struct TimedPayload {
  double t_s = 0.0, duration_s = 0.0;  // duration 0: not known
  GpmfPayload payload;
};

[[nodiscard]] ClipTelemetry telemetry_of(const SrtFile& file, const std::string& name);
// Rotations of the gyro are integrated to attitudes in the axes that the camera states: X, Y, Z of ORIO (Z, X, Y as the
// columns of cameras that state none), so that camera.mount_rpy_deg describes how these lie to the lens.
[[nodiscard]] ClipTelemetry telemetry_of(std::span<const TimedPayload> payloads);

// Beside or in the video: an SRT file of its name, otherwise a GPMF stream. Never throws for what they hold: `trouble`.
// may_hold_gpmf: false where the container is known to have no such stream, which spares opening it.
[[nodiscard]] ClipTelemetry find_telemetry(const std::string& video, bool may_hold_gpmf = true);
// The same of an .SRT file, of GPMF bytes (.raw, .gpmf) or of a video. Throws std::runtime_error where there is none.
[[nodiscard]] ClipTelemetry read_telemetry(const std::string& file);

// In words what was found, one statement each; without the times of frames, which the clock of frames describes.
[[nodiscard]] std::vector<std::string> telemetry_words(const ClipTelemetry& telemetry);

// Throws std::runtime_error where the focal length or the digital zoom changes by more than tracking follows.
void refuse_zoom(const std::string& video, const ClipTelemetry& telemetry);

}  // namespace drivers

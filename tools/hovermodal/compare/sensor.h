#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/compare/sensor_comparison.h"
#include "tools/hovermodal/answer.h"

namespace tools {

// `hovermodal compare --sensor`, as on the command line.
struct SensorOptions {
  std::string sensor, run, channel, sensor_channel;
  std::string quantity;  // of the sensor: d, v, a; empty = from its unit
  std::string unit;      // of the sensor; empty = from its file
  std::optional<double> sensor_rate_hz, rate_hz;
  std::vector<double> band;  // empty, or low and high
  std::optional<double> mm_per_px, most_offset_s;
  std::string report;
  bool is_quiet = false;  // no progress
};

// Everything that is shown about one comparison. Lengths in `unit`.
struct SensorFindings {
  core::SensorComparison comparison;
  std::string channel, run, sensor_channel, sensor;
  std::string unit;        // of the channel: mm; px or another where the sensor's scale does not apply
  bool is_scaled = false;  // true: units differ or are unknown, so the sensor was scaled by the ratio
  std::optional<double> mm_per_px;
  double camera_rate_hz = 0.0, sensor_rate_hz = 0.0;
  std::size_t n_camera = 0, n_sensor = 0;
  int n_integrations = 0;       // of the sensor
  double camera_first_s = 0.0;  // file times of the first samples; camera: when its first sample is seen
  double sensor_first_s = 0.0;
  std::vector<std::string> remarks;

  // On the clocks of the files.
  [[nodiscard]] double middle_s() const noexcept { return comparison.alignment.clock.middle_s + camera_first_s; }
  [[nodiscard]] double offset_s() const noexcept {
    return comparison.alignment.clock.offset_s + sensor_first_s - camera_first_s;
  }
};

// Throws std::invalid_argument where the files do not fit the options, FileError on what is no table, and
// std::runtime_error where the records cannot be compared.
void compare_sensor(const SensorOptions& options, const Answer& answer);

[[nodiscard]] std::string sensor_text(const SensorFindings& findings);
[[nodiscard]] std::string sensor_json(const SensorFindings& findings);
[[nodiscard]] std::string sensor_svg(const SensorFindings& findings);

}  // namespace tools

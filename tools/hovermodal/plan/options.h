#pragma once

#include <string>
#include <vector>

#include "core/planning/hover_plan.h"
#include "drivers/host/command_line.h"
#include "tools/hovermodal/answer.h"

namespace tools {

// Values of the command line, in its units. 0 or empty: not given.
struct PlanOptions {
  std::string structure = "shear", axis, shapes_file;
  int storeys = 0, regions = 0;
  double storey_mm = 0.0, size_m = 0.0;
  std::vector<double> frequency_hz, damping_percent{1.0}, amplitude_mm;
  double distance_m = 0.0;
  double focal_px = 0.0, focal_mm = 0.0, sensor_width_mm = 0.0, fov_deg = 0.0;
  std::string image = "1080p", direction = "down";
  double fps = 25.0, readout_ms = 0.0, exposure_ms = 0.0;
  std::vector<double> rates_hz{24, 25, 29.97, 30, 48, 50, 59.94, 60, 100, 119.88, 120};
  int points = 30;
  std::string texture = "ordinary", region_mm;
  double gradient_grey = 0.0, noise_grey = 2.0, window_px = 21.0, point_sigma_px = 0.0;
  double sigma_f_percent = 0.3, sigma_zeta_percent = 20.0;
  double hover_min = 0.0, battery_min = 0.0;
  std::string folder;
  Answer answer;
};

void add_plan_options(drivers::Command& command, PlanOptions& options);

// Throws std::invalid_argument naming the option: contradictory, missing or out of range.
[[nodiscard]] core::planning::PlanInput plan_input(const drivers::Command& command, const PlanOptions& options);

}  // namespace tools

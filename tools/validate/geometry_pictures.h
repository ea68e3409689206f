#pragma once

#include <complex>
#include <string>
#include <vector>

#include "core/types/displacement.h"
#include "firmware_app/replay/analysis.h"
#include "firmware_app/report/plot/svg_document.h"
#include "tools/validate/geometry_flight.h"
#include "tools/validate/geometry_sensors.h"

namespace tools {

// One mode as one sensor found it: components of the floors from the lowest.
struct SensorMode {
  bool found = false;
  double frequency_hz = 0.0;
  std::vector<std::complex<double>> shape;
};

// Figures 6 to 9 of the paper from one simulated record: scale over time, measured and true displacements,
// cross-spectrum of floors 5 and 6 by three sensors, shapes by the same three.
class PaperPictures {
 public:
  explicit PaperPictures(std::string folder) : folder_(std::move(folder)) {}  // created if missing

  // Samples of the aircraft's camera, and the true ones.
  void add(const core::DisplacementSample& sample, const core::DisplacementSample& truth);

  struct Record {
    const SimulateJob& job;
    const app::ChannelSeries& acceleration;
    const StationaryRecord& stationary;
    const AnalysedFlight& flight;
    const std::vector<std::vector<SensorMode>>& modes;  // accelerometers, stationary camera, UAV
  };
  // Writes figure_6_scale.svg, figure_7_displacements.svg, figure_8_cpsd.svg, figure_9_shapes.svg. Throws
  // drivers::FileError.
  void draw(const Record& record) const;

 private:
  void write(const char* name, const std::string& text) const;
  [[nodiscard]] std::string scale_figure(const Record& record) const;
  [[nodiscard]] std::string displacement_figure(const Record& record) const;

  std::string folder_;
  std::vector<app::PlotPoint> scale_;
  std::vector<std::vector<app::PlotPoint>> relative_, absolute_;  // by channel
};

}  // namespace tools

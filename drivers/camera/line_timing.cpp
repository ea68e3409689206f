#include "drivers/camera/line_timing.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace drivers {

LineTiming checked_line_timing(double readout_ms, double exposure_ms) {
  constexpr double kMaxReadout_ms = 1000.0;
  constexpr double kMaxExposure_ms = 10000.0;
  if (!(std::fabs(readout_ms) <= kMaxReadout_ms)) {
    throw std::invalid_argument(
        fmt::format("camera.readout_ms = {}: must be within -{} .. {} ms", readout_ms, kMaxReadout_ms, kMaxReadout_ms));
  }
  if (!(exposure_ms >= 0.0 && exposure_ms <= kMaxExposure_ms)) {
    throw std::invalid_argument(
        fmt::format("camera.exposure_ms = {}: must be within 0 (unknown) .. {} ms", exposure_ms, kMaxExposure_ms));
  }
  return {std::llround(readout_ms * 1e6), std::llround(exposure_ms * 1e6)};
}

}  // namespace drivers

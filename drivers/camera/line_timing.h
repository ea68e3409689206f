#pragma once

#include <cstdint>

namespace drivers {

struct LineTiming {
  std::int64_t readout_ns = 0;
  std::int64_t exposure_ns = 0;
};

// Declared readout (signed) and exposure, ms. Throws std::invalid_argument for NaN, |readout| > 1 s, exposure < 0 or
// > 10 s: no camera is that slow, so the value was meant in another unit.
[[nodiscard]] LineTiming checked_line_timing(double readout_ms, double exposure_ms);

}  // namespace drivers

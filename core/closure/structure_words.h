#pragma once

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "core/structure/frame_fit.h"

namespace core::closure {

// Text helpers of structure_level*.cpp.

inline double relative_sigma(const structure::ReferenceMode& mode) { return mode.sigma_hz / mode.frequency_hz; }

inline std::string number(double value) {
  std::ostringstream text;
  text.precision(3);
  text << value;
  return text.str();
}

// rms of the relative errors of the model's frequencies, percent.
inline double rms_percent(const std::vector<structure::ReferenceMode>& reference, const structure::FrameModes& modes) {
  double squares = 0.0;
  for (const structure::ReferenceMode& mode : reference) {
    const double error = modes.frequency_hz(mode.number - 1) / mode.frequency_hz - 1.0;
    squares += error * error;
  }
  return 100.0 * std::sqrt(squares / static_cast<double>(reference.size()));
}

}  // namespace core::closure

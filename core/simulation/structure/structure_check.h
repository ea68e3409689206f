#pragma once

#include <cmath>
#include <stdexcept>
#include <string>

namespace core::simulation {

// Error messages for structures: what, its value, and a remedy.
[[noreturn]] inline void refuse_structure(const std::string& what) {
  throw std::invalid_argument("simulation: structure: " + what);
}

inline void require_structure(bool ok, const std::string& what, double value, const std::string& advice) {
  if (!ok) refuse_structure(what + " is " + std::to_string(value) + "; " + advice);
}

inline void require_positive(const std::string& what, double value) {
  require_structure(std::isfinite(value) && value > 0.0, what, value, "give more than 0");
}

}  // namespace core::simulation

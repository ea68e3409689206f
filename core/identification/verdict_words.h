#pragma once

#include <cstdio>
#include <string>
#include <utility>

#include "core/types/modal_estimate.h"

namespace core {

// A reason, as by printf.
template <class... Args>
[[nodiscard]] std::string in_words(const char* format, Args... args) {
  char buffer[200];
  std::snprintf(buffer, sizeof buffer, format, args...);
  return buffer;
}

inline void set(Mode& mode, Verdict verdict, std::string reason) {
  mode.verdict = verdict;
  mode.reason = std::move(reason);
}

// No mode, so that its standard deviations would mean nothing.
inline void set_numerical(Mode& mode, std::string reason) {
  set(mode, Verdict::kNumerical, std::move(reason));
  mode.frequency_std_hz.reset(), mode.damping_std.reset(), mode.shape_std.clear();
}

}  // namespace core

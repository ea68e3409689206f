#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/types/closure_result.h"

namespace core::closure {

// Plain results of residual diagnosis over all levels of one run; each level uses the record repaired by the previous
// one.

// One level: clock and frames, observation, response or structure.
struct LoopLevel {
  std::string level;
  std::string skipped;  // reason why there is no result; empty: there is one
  std::optional<double> residual_before, residual_after;
  std::string unit;  // of these
  struct Finding {
    std::string effect;  // with its parameters
    std::string repair;  // repair of the record; empty: not possible at this level
  };
  std::vector<Finding> findings;
  std::string left;                     // description of what remains unexplained
  std::optional<ClosureResult> result;  // of levels that use the common loop
  struct Picture {
    std::string title, svg;  // a complete SVG file
  };
  std::vector<Picture> pictures = {};
};

// A mode as identified before any repair and after the last.
struct LoopMode {
  struct Estimate {
    double frequency_hz = 0.0, damping_ratio = 0.0;
    std::optional<double> frequency_std_hz, damping_std;
    std::optional<double> error_percent;   // of the frequency, against the reference
    std::optional<double> halves_percent;  // frequency of the second half of the record minus that of the first
  };
  std::optional<Estimate> before, after;
  std::optional<double> reference_hz;
};

struct LoopResult {
  std::vector<LoopLevel> levels;
  std::vector<LoopMode> modes;
  bool has_reference = false;
  std::optional<double> error_before, error_after;  // rms over the modes: of error_percent, or else of halves_percent
  std::vector<std::string> remarks;

  // The error that the result reports of an estimate: against the reference, or else between the halves.
  [[nodiscard]] std::optional<double> compared(const std::optional<LoopMode::Estimate>& one) const {
    if (!one) return std::nullopt;
    return has_reference ? one->error_percent : one->halves_percent;
  }
};

}  // namespace core::closure

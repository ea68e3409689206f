#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/types/closure_result.h"

namespace core::closure {

// Residual diagnosis ("closing the loop") of one stretch of a run: published by the service in flight.
struct ClosureReport {
  std::uint64_t number = 0;                             // 0, 1, 2, ... over the run
  std::uint64_t first_sequence = 0, last_sequence = 0;  // frames
  std::int64_t t_stream_ns = 0;                         // of the last frame
  double duration_s = 0.0;
  bool final = false;   // the run has ended
  double took_s = 0.0;  // processor time; not part of the result
  std::string refused;  // reason why no conclusion is possible; `result` is then empty
  ClosureResult result;
  // With closure.adopt: auto. Corrections started or withdrawn by this report, with the reason; and all that are in
  // force.
  std::vector<std::string> changes, in_force;
};

}  // namespace core::closure

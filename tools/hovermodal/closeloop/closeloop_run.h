#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/hovermodal/answer.h"

namespace tools {

// `closeloop --run out`: all levels of a finished run, one after the other.
struct RunLoop {
  std::string folder, config, structure, reference, report;  // report empty: the run's own folder
  std::vector<std::string> overrides, bases;
  double max_frequency_hz = 0.0;
  std::uint64_t seed = 1;
  Answer answer;
};
// Throws std::invalid_argument, app::ConfigError, drivers::FileError.
void close_run(const RunLoop& request);

}  // namespace tools

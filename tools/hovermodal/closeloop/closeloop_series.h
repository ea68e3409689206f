#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/host/command_line.h"
#include "tools/hovermodal/answer.h"
#include "tools/hovermodal/identify/series_input.h"

namespace tools {

// `closeloop --record series.csv`: the response level.
struct SeriesLoop {
  SeriesRequest request;
  std::string clock;
  std::string input_record;
  double clock_sigma_ms = 0.0;
  bool free_decay = false, input_unknown = false, average_rate = false;
  double decay_s = 1.3, max_frequency_hz = 0.0;
};

// Options common to all forms of closeloop.
struct LoopRequest {
  std::vector<std::string> records;
  std::string reference, report;
  std::uint64_t seed = 1;
  std::size_t n_surrogates = 333;
  Answer answer;
};

void add_series_options(drivers::Command& command, SeriesLoop& options);
// Throws std::invalid_argument, drivers::FileError.
void close_series(const LoopRequest& request, const SeriesLoop& options);

}  // namespace tools

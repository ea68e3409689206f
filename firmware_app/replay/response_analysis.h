#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/closure/response/channel_model.h"
#include "core/types/closure_result.h"
#include "firmware_app/replay/analysis.h"

namespace app {

// Where the times of a series come from: what of its clock may be doubted.
struct SeriesClock {
  bool times_known = false;      // time stamps tell lost, repeated and late frames: they are no effects to look for
  bool rate_is_average = false;  // the rate is samples / duration, not that of a sensor
};

// Channels of a series for the response level: base channels are the input. `record_series` is the way back, with the
// names, delays and order of channels of `like`; without_input: base channels are left out.
[[nodiscard]] core::closure::ChannelRecord response_record(const ChannelSeries& series, const SeriesClock& clock = {});
[[nodiscard]] ChannelSeries record_series(const core::closure::ChannelRecord& record, const ChannelSeries& like,
                                          bool without_input = false);

struct ResponseOptions {
  SeriesClock clock;
  bool input_unknown = false;  // the base is taken for an effect that may be adopted, not for a known input
  std::size_t n_surrogates = 333;
  std::uint64_t seed = 1;
  std::function<void(const std::string&)> progress = {};
};

// The response level on a series: what a linear structure under white forces leaves, traced to an effect, and the
// series as the adopted effects repair it.
struct ResponseAnalysis {
  core::closure::ClosureResult result;
  std::vector<std::string> adopted;
  std::vector<std::string> repairs;  // per adopted effect, in words; "" = the series stays as it is
  ChannelSeries before, after;       // to identify modes from: without an input that is not to be known
};
// Throws std::invalid_argument where the series is too short, or does not move.
[[nodiscard]] ResponseAnalysis analyse_response(const ChannelSeries& series, const ResponseOptions& options);

}  // namespace app

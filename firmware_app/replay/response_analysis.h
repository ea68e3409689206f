#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/closure/response/channel_model.h"
#include "core/types/closure_result.h"
#include "core/types/loop_progress.h"
#include "firmware_app/replay/analysis.h"

namespace app {

// Source of a series' times: which faults of its clock are possible.
struct SeriesClock {
  bool times_known = false;      // time stamps show lost, repeated and late frames: these are not searched for
  bool rate_is_average = false;  // the rate is samples / duration, not that of a sensor
};

// Channels of a series for the response level: base channels are the input. `record_series` is the inverse, with the
// names, delays and order of channels of `like`; without_input: base channels are left out.
[[nodiscard]] core::closure::ChannelRecord response_record(const ChannelSeries& series, const SeriesClock& clock = {});
[[nodiscard]] ChannelSeries record_series(const core::closure::ChannelRecord& record, const ChannelSeries& like,
                                          bool without_input = false);

struct ResponseOptions {
  SeriesClock clock;
  bool input_unknown = false;  // the base is treated as an effect that may be adopted, not as a known input
  std::size_t n_surrogates = 333;
  std::uint64_t seed = 1;
  core::closure::TellProgress progress = {};
};

// The response level on a series: attributes what a linear structure under white forces does not explain to an effect,
// and corrects the series by the adopted effects.
struct ResponseAnalysis {
  core::closure::ClosureResult result;
  std::vector<std::string> adopted;
  std::vector<std::string> repairs;  // per adopted effect, in words; "" = the series is not changed
  ChannelSeries before, after;       // for identifying modes; without an input that is not to be used as known
};
// Throws std::invalid_argument where the series is too short, or contains no motion.
[[nodiscard]] ResponseAnalysis analyse_response(const ChannelSeries& series, const ResponseOptions& options);

}  // namespace app

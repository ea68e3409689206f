// hovermodal closeloop --record series.csv: the response of channels to unknown forces, or to a measured base.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "firmware_app/replay/response_analysis.h"
#include "firmware_app/replay/run_folder.h"
#include "tools/hovermodal/closeloop/series_loop.h"
#include "tools/hovermodal/closeloop/series_modes.h"

namespace tools {

void close_channels(const LoopRequest& request, const SeriesLoop& options, app::ChannelSeries series) {
  const bool has_base = std::any_of(series.channels.begin(), series.channels.end(), [](auto& c) { return c.is_base; });
  if (options.input_unknown && !has_base)
    throw std::invalid_argument("--input-unknown needs --input: the column of the measured input");
  app::ResponseOptions loop;
  loop.input_unknown = options.input_unknown;
  loop.clock.rate_is_average = options.average_rate;
  loop.clock.times_known = app::use_measured_times(request.records.front(), series);
  if (loop.clock.times_known) {
    request.answer.note(
        "the frames' times were measured: the series is interpolated to an even grid, its clock is known\n");
  }
  loop.n_surrogates = request.n_surrogates;
  loop.seed = request.seed;
  app::ResponseAnalysis found = [&] {
    const ProgressLine line(request.answer);
    loop.progress = line.teller();
    return app::analyse_response(series, loop);
  }();
  add_modes(found.result, found.before, found.after, options.max_frequency_hz, request.reference);
  show_response(request, found.result, "closure.json");
  for (std::size_t i = 0; i < found.adopted.size(); ++i) {
    request.answer.note("repair of {}: {}\n", found.adopted[i],
                        found.repairs[i].empty() ? "not applicable, the series stays as it is" : found.repairs[i]);
  }
}

}  // namespace tools

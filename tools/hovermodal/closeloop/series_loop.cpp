#include "tools/hovermodal/closeloop/series_loop.h"

#include <algorithm>
#include <filesystem>

#include "core/closure/closure_loop.h"
#include "core/closure/response/response_level.h"
#include "firmware_app/report/earlier_files.h"
#include "tools/hovermodal/closeloop/closing.h"
#include "tools/hovermodal/closeloop/series_modes.h"

namespace tools {
namespace {

constexpr std::size_t kWhenPlain = 12;

}  // namespace

using core::closure::ClosureResult;
using core::closure::ResponseLevel;
using core::closure::ResponseModel;

ClosureResult close_response(const LoopRequest& request, const ResponseModel& model, std::size_t most_surrogates,
                             std::vector<std::string>* adopted) {
  core::closure::ClosureOptions loop;
  loop.n_surrogates = std::min(request.n_surrogates, most_surrogates);
  loop.n_surrogates_when_plain = kWhenPlain;
  loop.seed = request.seed;
  ResponseLevel level(model);
  ClosureResult result = close_level(request.answer, level, loop);
  if (adopted != nullptr) *adopted = level.adopted();
  return result;
}

void show_response(const LoopRequest& request, const ClosureResult& result, const std::string& file) {
  if (file == "closure.json") {
    keep_earlier_closure(request.report);
  } else if (!request.report.empty()) {
    app::keep_earlier(request.report, std::filesystem::path(file).stem().string(), {file});
  }
  show_closure(request.answer, result, identified_text(result), request.report, file);
}

// Pairs both sets of modes with the reference; with the error before and after if there is one.
void add_modes(ClosureResult& result, const app::ChannelSeries& before, const app::ChannelSeries& after,
               double max_frequency_hz, const std::string& reference_path) {
  const auto reference = read_reference_modes(reference_path);
  result.modes_before = modes_of_series(before, max_frequency_hz, reference);
  result.modes_after = modes_of_series(after, max_frequency_hz, reference);
}

}  // namespace tools

#include "firmware_app/replay/response_analysis.h"

#include <algorithm>
#include <utility>

#include "core/closure/closure_loop.h"
#include "core/closure/response/response_level.h"

namespace app {
namespace {

using core::closure::ChannelRecord;
using Eigen::Index;

constexpr std::size_t kWhenPlain = 12;

}  // namespace

ChannelRecord response_record(const ChannelSeries& series, const SeriesClock& clock) {
  ChannelRecord out;
  out.rate_hz = series.rate_hz;
  out.rate_is_average = clock.rate_is_average, out.times_known = clock.times_known;
  const auto n = static_cast<Index>(series.value.front().size());
  Index n_base = 0;
  for (const auto& channel : series.channels) n_base += channel.is_base ? 1 : 0;
  out.value.resize(n, static_cast<Index>(series.channels.size()) - n_base);
  out.input.resize(n, n_base);
  out.input_alike = n_base > 0;
  int quantity = -1;
  Index value = 0, input = 0;
  for (std::size_t c = 0; c < series.channels.size(); ++c) {
    const Eigen::Map<const Eigen::VectorXd> column(series.value[c].data(), n);
    const core::ChannelInfo& channel = series.channels[c];
    out.input_alike = out.input_alike && (quantity < 0 || quantity == channel.n_integrations);
    quantity = channel.n_integrations;
    if (channel.is_base) {
      out.input.col(input++) = column;
      out.input_delay_s.push_back(channel.row_delay_s);
    } else {
      out.value.col(value++) = column;
      out.delay_s.push_back(channel.row_delay_s);
    }
  }
  return out;
}

ChannelSeries record_series(const ChannelRecord& record, const ChannelSeries& like, bool without_input) {
  ChannelSeries out;
  out.rate_hz = record.rate_hz;
  out.unit = like.unit;
  Index value = 0, input = 0;
  for (const auto& channel : like.channels) {
    if (channel.is_base && (without_input || record.input.cols() == 0)) continue;
    const Eigen::VectorXd column = channel.is_base ? record.input.col(input++) : record.value.col(value++);
    out.channels.push_back(channel);
    out.value.emplace_back(column.begin(), column.end());
  }
  return out;
}

ResponseAnalysis analyse_response(const ChannelSeries& series, const ResponseOptions& options) {
  const ChannelRecord record = response_record(series, options.clock);
  const core::closure::ChannelModel model(
      record, options.input_unknown ? core::closure::InputUse::kUnknown : core::closure::InputUse::kKnown);
  core::closure::ResponseLevel level(model);
  core::closure::ClosureOptions loop;
  loop.n_surrogates = options.n_surrogates;
  loop.n_surrogates_when_plain = kWhenPlain;
  loop.seed = options.seed;
  loop.progress = options.progress;
  ResponseAnalysis out;
  out.result = core::closure::close_loop(level, loop);
  out.adopted = level.adopted();
  out.repairs = model.repairs(out.adopted);
  const bool coloured = std::find(out.adopted.begin(), out.adopted.end(), "input_colour") != out.adopted.end();
  out.before = record_series(record, series, options.input_unknown);
  // Where the input is an adopted effect: the record without it is the model before, the record with it the one after.
  ChannelRecord after = model.corrected(out.adopted);
  if (after.input.cols() == 0 && record.input.cols() > 0 && after.n_samples() == record.n_samples())
    after.input = record.input;
  out.after = record_series(after, series, options.input_unknown && !coloured);
  return out;
}

}  // namespace app

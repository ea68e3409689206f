// hovermodal closeloop --record series.csv: the response of channels to unknown forces, or to a measured base.
#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "core/closure/response/channel_model.h"
#include "tools/hovermodal/closeloop/series_loop.h"
#include "tools/hovermodal/closeloop/series_modes.h"

namespace tools {
namespace {

using core::closure::ChannelRecord;
using Eigen::Index;

ChannelRecord record_of(const app::ChannelSeries& series) {
  ChannelRecord out;
  out.rate_hz = series.rate_hz;
  const auto n = static_cast<Index>(series.value.front().size());
  Index n_base = 0;
  for (const auto& channel : series.channels) n_base += channel.is_base ? 1 : 0;
  out.value.resize(n, static_cast<Index>(series.channels.size()) - n_base);
  out.input.resize(n, n_base);
  Index value = 0, input = 0;
  for (std::size_t c = 0; c < series.channels.size(); ++c) {
    const Eigen::Map<const Eigen::VectorXd> column(series.value[c].data(), n);
    if (series.channels[c].is_base) {
      out.input.col(input++) = column;
    } else {
      out.value.col(value++) = column;
    }
  }
  return out;
}

// The record as the model corrects it, in the series' order of channels.
app::ChannelSeries series_of(const ChannelRecord& record, const app::ChannelSeries& like, bool with_input) {
  app::ChannelSeries out;
  out.rate_hz = record.rate_hz;
  out.unit = like.unit;
  Index value = 0, input = 0;
  for (const auto& channel : like.channels) {
    if (channel.is_base && (!with_input || record.input.cols() == 0)) continue;
    const Eigen::VectorXd column = channel.is_base ? record.input.col(input++) : record.value.col(value++);
    out.channels.push_back(channel);
    out.value.emplace_back(column.begin(), column.end());
  }
  return out;
}

}  // namespace

void close_channels(const LoopRequest& request, const SeriesLoop& options, const app::ChannelSeries& series) {
  const ChannelRecord record = record_of(series);
  if (options.input_unknown && record.input.cols() == 0)
    throw std::invalid_argument("--input-unknown needs --input: the column of the measured input");
  const core::closure::ChannelModel model(
      record, options.input_unknown ? core::closure::InputUse::kUnknown : core::closure::InputUse::kKnown);
  std::vector<std::string> adopted;
  core::closure::ClosureResult result = close_response(request, model, request.n_surrogates, &adopted);
  const bool coloured = std::find(adopted.begin(), adopted.end(), "input_colour") != adopted.end();
  const ChannelRecord after = model.corrected(adopted);
  add_modes(result, series_of(record, series, !options.input_unknown),
            series_of(after.input.cols() > 0 ? after : record, series, !options.input_unknown || coloured),
            options.max_frequency_hz, request.reference);
  show_response(request, result, "closure.json");
}

}  // namespace tools

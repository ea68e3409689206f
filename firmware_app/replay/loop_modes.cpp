#include "firmware_app/replay/loop_modes.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace app {
namespace {

using core::closure::LoopMode;
using core::closure::LoopResult;

constexpr double kNearReference = 0.1, kNearMode = 0.06, kNearHalf = 0.04;  // relative: may be the same mode

// The nearest of a list within `share` of the frequency; empty: none.
template <class List, class Frequency>
auto nearest(const List& list, double hz, double share, Frequency frequency) {
  auto best = list.end();
  double least = share * hz;
  for (auto one = list.begin(); one != list.end(); ++one) {
    const double off = std::abs(frequency(*one) - hz);
    if (off < least) least = off, best = one;
  }
  return best;
}

// Samples [first, last) of a series.
ChannelSeries part_of(const ChannelSeries& series, std::size_t first, std::size_t last) {
  ChannelSeries out = series;
  for (std::vector<double>& values : out.value)
    values = {values.begin() + static_cast<std::ptrdiff_t>(first), values.begin() + static_cast<std::ptrdiff_t>(last)};
  return out;
}

std::optional<double> rms(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  double squares = 0.0;
  for (const double v : values) squares += v * v;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

}  // namespace

LoopModes::LoopModes(std::vector<double> reference_hz, double max_frequency_hz)
    : reference_hz_(std::move(reference_hz)), max_frequency_hz_(max_frequency_hz) {}

SeriesResult LoopModes::identified(const ChannelSeries& series) const {
  SeriesOptions options;
  options.identifier.max_frequency_hz = max_frequency_hz_;
  try {
    return identify_series(series, options);
  } catch (const std::invalid_argument&) {
    return {};  // too short to identify: no modes are stated
  }
}

std::vector<LoopModes::Estimate> LoopModes::estimates(const ChannelSeries& series,
                                                      const core::ModalEstimate& of_whole) const {
  const std::size_t n = series.value.front().size();
  const std::vector<core::Mode> first = identified(part_of(series, 0, n / 2)).estimate.modes,
                                second = identified(part_of(series, n / 2, n)).estimate.modes;
  const auto hz = [](const core::Mode& mode) { return mode.frequency_hz; };
  std::vector<Estimate> out;
  for (const core::Mode& mode : of_whole.modes) {
    Estimate one{mode.frequency_hz, mode.damping_ratio, mode.frequency_std_hz, mode.damping_std, {}, {}};
    const auto a = nearest(first, mode.frequency_hz, kNearHalf, hz),
               b = nearest(second, mode.frequency_hz, kNearHalf, hz);
    if (a != first.end() && b != second.end())
      one.halves_percent = 100.0 * (b->frequency_hz - a->frequency_hz) / mode.frequency_hz;
    const auto known = nearest(reference_hz_, mode.frequency_hz, kNearReference, [](double f) { return f; });
    if (known != reference_hz_.end()) one.error_percent = 100.0 * (mode.frequency_hz / *known - 1.0);
    out.push_back(one);
  }
  return out;
}

LoopModes::Corrected LoopModes::compare(const ChannelSeries& before, const ChannelSeries& after,
                                        LoopResult& out) const {
  const auto hz = [](const Estimate& estimate) { return estimate.frequency_hz; };
  const std::vector<Estimate> first = estimates(before, identified(before).estimate);
  SeriesResult corrected = identified(after);
  std::vector<Estimate> last = estimates(after, corrected.estimate);
  for (const Estimate& one : first) {
    LoopMode mode;
    mode.before = one;
    if (const auto same = nearest(last, one.frequency_hz, kNearMode, hz); same != last.end()) {
      mode.after = *same;
      last.erase(same);
    }
    out.modes.push_back(mode);
  }
  for (const Estimate& one : last) out.modes.push_back({{}, one, {}});
  std::sort(out.modes.begin(), out.modes.end(), [](const LoopMode& a, const LoopMode& b) {
    return (a.after ? *a.after : *a.before).frequency_hz < (b.after ? *b.after : *b.before).frequency_hz;
  });
  out.has_reference = !reference_hz_.empty();
  std::vector<double> errors_before, errors_after;
  for (LoopMode& mode : out.modes) {
    const double f = (mode.after ? *mode.after : *mode.before).frequency_hz;
    const auto known = nearest(reference_hz_, f, kNearReference, [](double hz_known) { return hz_known; });
    if (known != reference_hz_.end()) mode.reference_hz = *known;
    if (!mode.before || !mode.after) continue;
    const auto& [a, b] = out.has_reference ? std::pair(mode.before->error_percent, mode.after->error_percent)
                                           : std::pair(mode.before->halves_percent, mode.after->halves_percent);
    if (a && b) errors_before.push_back(*a), errors_after.push_back(*b);
  }
  out.error_before = rms(errors_before), out.error_after = rms(errors_after);
  Corrected result{std::move(corrected.estimate), {}};
  for (core::ChannelInfo& channel : corrected.channels) result.channel_names.push_back(std::move(channel.name));
  return result;
}

}  // namespace app

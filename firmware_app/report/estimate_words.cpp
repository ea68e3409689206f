#include "firmware_app/report/estimate_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace app {
namespace {

std::size_t count_of(const core::ModalEstimate& estimate, core::Verdict verdict) {
  return static_cast<std::size_t>(std::count_if(estimate.rejected.begin(), estimate.rejected.end(),
                                                [&](const core::Mode& mode) { return mode.verdict == verdict; }));
}

void add_channels(const core::ModalEstimate& estimate, const std::vector<core::ChannelInfo>& channels,
                  std::vector<std::string>& words) {
  const std::size_t n = std::min(estimate.channels.size(), channels.size());
  for (std::size_t c = 0; c < n; ++c) {
    const core::ChannelRecord& record = estimate.channels[c];
    if (record.takes_part) continue;
    words.push_back(fmt::format(
        "Channel {} takes no part: {}. Its component of every shape is unknown.{}", channels[c].name, record.reason,
        channels[c].is_base ? " It is the base: peaks of the input cannot be distinguished from modes." : ""));
  }
  for (std::size_t c = 0; c < n; ++c) {
    const std::uint64_t n_outlying = estimate.channels[c].n_outlying;
    if (n_outlying > 0)
      words.push_back(fmt::format("{} sample{} of {} {} masked: the neighbours in time do not allow {}.", n_outlying,
                                  n_outlying == 1 ? "" : "s", channels[c].name, n_outlying == 1 ? "was" : "were",
                                  n_outlying == 1 ? "it" : "them"));
  }
}

void add_open_poles(const core::ModalEstimate& estimate, std::vector<std::string>& words) {
  const std::size_t n_open = count_of(estimate, core::Verdict::kAmbiguous);
  const std::size_t n_candidates = count_of(estimate, core::Verdict::kCandidate);
  if (n_open > 0 && estimate.modes.empty())
    words.push_back(
        fmt::format("{} found whose true frequency is one of several (alias order open): see the other poles.",
                    n_open == 1 ? "A mode was" : fmt::format("{} modes were", n_open)));
  if (n_candidates > 0)
    words.push_back(fmt::format(
        "{}: the record is too short for a verdict.",
        n_candidates == 1 ? "One pole is a candidate" : fmt::format("{} poles are candidates", n_candidates)));
}

}  // namespace

std::vector<std::string> estimate_words(const core::ModalEstimate& estimate,
                                        const std::vector<core::ChannelInfo>& channels) {
  std::vector<std::string> words;
  add_channels(estimate, channels, words);
  add_open_poles(estimate, words);
  return words;
}

std::string other_frequencies_text(const core::Mode& mode) {
  if (mode.may_be_hz.empty()) return {};
  std::string text = ", or ";
  for (std::size_t i = 0; i < mode.may_be_hz.size(); ++i)
    text += fmt::format("{}{:.4g}", i == 0 ? "" : ", ", mode.may_be_hz[i]);
  return text + " Hz";
}

core::ModalEstimate with_unknown_components(const core::ModalEstimate& estimate) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  core::ModalEstimate out = estimate;
  for (auto* modes : {&out.modes, &out.rejected}) {
    for (core::Mode& mode : *modes) {
      for (std::size_t c = 0; c < mode.shape.size() && c < out.channels.size(); ++c) {
        if (out.channels[c].takes_part) continue;
        mode.shape[c] = {kUnknown, kUnknown};
        if (c < mode.shape_std.size()) mode.shape_std[c] = kUnknown;
      }
    }
  }
  return out;
}

}  // namespace app

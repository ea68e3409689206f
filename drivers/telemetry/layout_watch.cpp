#include "drivers/telemetry/layout_watch.h"

#include <fmt/format.h>

namespace drivers {

void LayoutWatch::note_layout(Topic topic, int layout) noexcept {
  seen_[topic].layout = layout;
  ++seen_[topic].n_layout;
}

void LayoutWatch::note_fingerprint(Topic topic, std::int64_t heard, std::int64_t expected) noexcept {
  Seen& seen = seen_[topic];
  seen.n_in_a_row = heard == seen.heard && seen.n_in_a_row > 0 ? seen.n_in_a_row + 1 : 1;
  seen.heard = heard;
  seen.expected = expected;
  if (seen.n_in_a_row < kConvincing) return;
  seen.n_told = heard == seen.told && seen.n_told > 0 ? seen.n_told + 1 : seen.n_in_a_row;
  seen.told = heard;
}

std::vector<std::string> LayoutWatch::words(const std::string& channel_prefix) const {
  constexpr const char* kRemedy = "use the two programs of one version";
  std::vector<std::string> out;
  for (std::size_t i = 0; i < kTopics; ++i) {
    const auto topic = static_cast<Topic>(i);
    const Seen& seen = seen_[i];
    if (seen.n_layout > 0) {
      out.push_back(fmt::format(
          "{}: this service speaks another version, layout {} of these messages where this "
          "program knows layout {} ({} messages not read); {}",
          topic_channel(channel_prefix, topic, seen.layout), seen.layout, kTopicLayouts[i], seen.n_layout, kRemedy));
    }
    if (seen.n_told > 0) {
      out.push_back(
          fmt::format("{}: this service speaks another version, fingerprint {:016x} where this program "
                      "knows {:016x} ({} messages not read); {}",
                      topic_channel(channel_prefix, topic), static_cast<std::uint64_t>(seen.told),
                      static_cast<std::uint64_t>(seen.expected), seen.n_told, kRemedy));
    }
  }
  return out;
}

}  // namespace drivers

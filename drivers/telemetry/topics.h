#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace drivers {

// Kinds of messages of a run, on one LCM channel each.
enum Topic : std::size_t { kModal, kDisplacement, kSpectrum, kTracks, kClosure, kHealth, kPreview, kTopics };
inline constexpr std::array<const char*, kTopics> kTopicSuffixes{"_MODAL",   "_DISPLACEMENT", "_SPECTRUM", "_TRACKS",
                                                                 "_CLOSURE", "_HEALTH",       "_PREVIEW"};

// The layout of each topic's messages. Raised by one with every change of a released type: messages
// of the new layout are then sent on a channel of another name, so that no listener to the old one receives bytes that
// it cannot decode. tests/unit/drivers/lcm_layout_test.cpp contains the fingerprints that belong to these numbers.
inline constexpr std::array<int, kTopics> kTopicLayouts{1, 1, 1, 1, 1, 1, 1};

// <prefix>_MODAL is layout 1, <prefix>_MODAL_V2 layout 2.
[[nodiscard]] inline std::string topic_channel(const std::string& prefix, Topic topic, int layout) {
  return prefix + kTopicSuffixes[topic] + (layout == 1 ? "" : "_V" + std::to_string(layout));
}
[[nodiscard]] inline std::string topic_channel(const std::string& prefix, Topic topic) {
  return topic_channel(prefix, topic, kTopicLayouts[topic]);
}

struct TopicLayout {
  Topic topic;
  int layout;  // 1 .. 999
};

// The inverse, for any layout; empty for a channel of another program.
[[nodiscard]] std::optional<TopicLayout> topic_of(std::string_view prefix, std::string_view lcm_channel);

// A regular expression, in LCM's form, for all topics in all layouts.
[[nodiscard]] std::string topics_pattern(const std::string& prefix);

}  // namespace drivers

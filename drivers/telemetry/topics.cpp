#include "drivers/telemetry/topics.h"

#include <charconv>

#include "drivers/telemetry/lcm_url.h"

namespace drivers {
namespace {

// "" is layout 1, "_V2" layout 2, ... ; 0 for anything else.
int layout_of(std::string_view ending) {
  constexpr std::string_view kMark = "_V";
  constexpr int kMost = 999;
  if (ending.empty()) return 1;
  if (ending.substr(0, kMark.size()) != kMark) return 0;
  ending.remove_prefix(kMark.size());
  int layout = 0;
  const auto [end, error] = std::from_chars(ending.data(), ending.data() + ending.size(), layout);
  const bool is_whole = error == std::errc{} && end == ending.data() + ending.size();
  return is_whole && layout >= 2 && layout <= kMost ? layout : 0;
}

}  // namespace

std::optional<TopicLayout> topic_of(std::string_view prefix, std::string_view lcm_channel) {
  if (lcm_channel.substr(0, prefix.size()) != prefix) return std::nullopt;
  const std::string_view rest = lcm_channel.substr(prefix.size());
  for (std::size_t i = 0; i < kTopics; ++i) {
    const std::string_view suffix = kTopicSuffixes[i];
    if (rest.substr(0, suffix.size()) != suffix) continue;
    if (const int layout = layout_of(rest.substr(suffix.size())); layout > 0) {
      return TopicLayout{static_cast<Topic>(i), layout};
    }
  }
  return std::nullopt;
}

std::string topics_pattern(const std::string& prefix) {
  std::string pattern = exact_pattern(prefix);
  for (std::size_t i = 0; i < kTopics; ++i) pattern += (i == 0 ? "(" : "|") + std::string(kTopicSuffixes[i]);
  return pattern + ")(_V[0-9]+)?";
}

}  // namespace drivers

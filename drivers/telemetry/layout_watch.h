#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/telemetry/topics.h"

namespace drivers {

// Tells a sender of another version from damaged bytes. Such a sender repeats itself: its messages come on a channel of
// another layout, or bear one wrong fingerprint again and again; noise does neither. One thread.
class LayoutWatch {
 public:
  static constexpr std::uint64_t kConvincing = 3;  // messages in a row with the same wrong fingerprint

  // A message on the channel of a layout that is not ours.
  void note_layout(Topic topic, int layout) noexcept;
  // A message on our channel whose first eight bytes are no fingerprint of ours.
  void note_fingerprint(Topic topic, std::int64_t heard, std::int64_t expected) noexcept;

  // One line for each topic that another version speaks: what, and what to do. Empty: none.
  [[nodiscard]] std::vector<std::string> words(const std::string& channel_prefix) const;

 private:
  struct Seen {
    int layout = 0;  // the newest other one; 0 = none
    std::uint64_t n_layout = 0;
    std::int64_t heard = 0, expected = 0;
    std::uint64_t n_in_a_row = 0, n_told = 0;  // n_told: messages of the fingerprint that convinced
    std::int64_t told = 0;
  };
  std::array<Seen, kTopics> seen_{};
};

}  // namespace drivers

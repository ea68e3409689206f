#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/telemetry/topics.h"

namespace drivers {

// Distinguishes a sender of another version from damaged bytes. Such a sender is consistent: its messages come on a
// channel of another layout, or have the same wrong fingerprint repeatedly; noise does neither.
class LayoutWatch {
 public:
  static constexpr std::uint64_t kConvincing = 3;  // messages in a row with the same wrong fingerprint

  // A message on the channel of another layout.
  void note_layout(Topic topic, int layout) noexcept;
  // A message on a known channel whose first eight bytes are an unknown fingerprint.
  void note_fingerprint(Topic topic, std::int64_t heard, std::int64_t expected) noexcept;

  // One line per topic for which another version was heard: what, and what to do. Empty: none.
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

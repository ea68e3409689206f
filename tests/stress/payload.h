#pragma once

#include <array>
#include <cstdint>

namespace stress {

// Far wider than a machine word: a reader of a half-written slot finds a word that does not match its number.
class Payload {
 public:
  void fill(std::uint64_t number) noexcept {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] = number * kFactor + i;
  }
  [[nodiscard]] std::uint64_t number() const noexcept { return words_[0] / kFactor; }
  [[nodiscard]] bool whole() const noexcept {
    for (std::size_t i = 0; i < words_.size(); ++i) {
      if (words_[i] != words_[0] + i) return false;
    }
    return words_[0] % kFactor == 0;
  }

 private:
  static constexpr std::uint64_t kFactor = 1000;
  std::array<std::uint64_t, 67> words_{};  // not a multiple of a cache line
};

}  // namespace stress

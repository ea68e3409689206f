#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace core {

// Detects single samples that are inconsistent with their neighbours in time, in a stream of several channels: a frame
// in which a region was tracked wrongly, a spike of a logger. A sample is an outlier if
//   - it departs from the line between its neighbours by more than kFar times the departure of nearly all of the
//     last kMemory samples, and
//   - the next sample returns to where the samples before it lead to, and
//   - its neighbours are no farther apart than usual.
// A release, an impact or a step does not return with the next sample and is kept, and so are the samples of the next
// kMotion: at most the first sample of an impact is lost (METHOD.md). The decision about a sample is made with
// the next one. One thread; does not allocate after construction.
class OutlierGate {
 public:
  static constexpr std::size_t kMemory = 64;  // departures from which the scale is computed

  explicit OutlierGate(std::size_t n_channels) : channels_(n_channels) {}

  // Adds the next grid cell of a channel; an unseen value is ignored. True: the sample before it is an outlier.
  [[nodiscard]] bool push(std::size_t channel, double value, bool seen) noexcept;
  // True if the newest sample departs from the line through the two before it and is not confirmed yet.
  [[nodiscard]] bool is_doubtful(std::size_t channel) const noexcept;
  void restart() noexcept;

  // Trivially copyable: part of a state that is saved.
  struct Channel {
    std::array<double, 3> last = {};             // the newest samples in order, outliers replaced by the line
    std::array<double, kMemory> departure = {};  // from the line between the neighbours, ring buffer
    std::array<double, kMemory> step = {};       // difference of the neighbours, ring buffer
    std::uint32_t n_last = 0, n_departures = 0, i_next = 0;
    std::uint32_t n_since_far = kMemory;  // samples since the last large departure that was not an outlier
    std::uint32_t n_since_outlier = kMemory;
    std::uint32_t is_last_far = 0;  // 1: the newest classified sample departed far, perhaps because of the next
  };
  [[nodiscard]] std::vector<Channel>& state() noexcept { return channels_; }
  [[nodiscard]] const std::vector<Channel>& state() const noexcept { return channels_; }
  [[nodiscard]] bool is_consistent() const noexcept;

 private:
  std::vector<Channel> channels_;
};

}  // namespace core

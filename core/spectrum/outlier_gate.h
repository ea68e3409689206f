#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace core {

// Detects single samples that their neighbours in time do not allow, in a stream of several channels: a frame in which a
// region was tracked wrongly, a spike of a logger. A sample is an outlier when
//   - it departs from the line between its neighbours by more than kFar times what nearly all samples of the last
//     kMemory did, and
//   - the next sample is back where the samples before it lead to, and
//   - its neighbours are no farther apart than usual.
// A release, an impact or a step does not return with the next sample and is kept, and so is what follows it for
// kMotion samples: at most the first sample of an impact is lost (METHOD.md). The decision about a
// sample is made with the next one. One thread; nothing allocates after construction.
class OutlierGate {
 public:
  static constexpr std::size_t kMemory = 64;  // departures that set the scale

  explicit OutlierGate(std::size_t n_channels) : channels_(n_channels) {}

  // The next grid cell of a channel; the value of an unseen one is ignored. True: the sample before it is an outlier.
  [[nodiscard]] bool push(std::size_t channel, double value, bool seen) noexcept;
  // The newest sample departs from the line through the two before it, and nothing has confirmed it yet.
  [[nodiscard]] bool is_doubtful(std::size_t channel) const noexcept;
  void restart() noexcept;

  // Trivially copyable: part of a state that is saved.
  struct Channel {
    std::array<double, 3> last = {};              // the newest samples in order, outliers replaced by their line
    std::array<double, kMemory> departure = {};   // of the line between the neighbours, a ring
    std::array<double, kMemory> step = {};        // between the neighbours, likewise
    std::uint32_t n_last = 0, n_departures = 0, i_next = 0;
    std::uint32_t n_since_far = kMemory;  // samples since one departed far and was no outlier
    std::uint32_t n_since_outlier = kMemory;
    std::uint32_t is_last_far = 0;        // 1: the newest judged sample did, and the next may turn out to be the reason
  };
  [[nodiscard]] std::vector<Channel>& state() noexcept { return channels_; }
  [[nodiscard]] const std::vector<Channel>& state() const noexcept { return channels_; }
  [[nodiscard]] bool is_consistent() const noexcept;

 private:
  std::vector<Channel> channels_;
};

}  // namespace core

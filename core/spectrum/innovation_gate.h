#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace core {

// Detects a sample of one channel that neither its own past nor the other channels allow: a frame in which one region
// was tracked wrongly by less than a vibration moves it. Each channel's second differences are predicted from the last
// twelve by an autoregressive model that follows the stream (METHOD.md). A sample is an outlier when
//   - it departs from what the samples before it and the one after it predict by more than kFar times what nearly all
//     of the last kMemory did,
//   - the next sample is where it would be without the departure, and
//   - at least two other channels were seen in both frames, and none was disturbed in them: what shakes a structure,
//     shakes more than one region.
// The decision about a sample is made with the next one. One thread; nothing allocates after construction.
class InnovationGate {
 public:
  static constexpr std::size_t kOrder = 12;   // of the model
  static constexpr std::size_t kMemory = 64;  // innovations that set the scale
  static constexpr std::size_t kHistory = kOrder + 4;

  explicit InnovationGate(std::size_t n_channels) : channels_(n_channels) {}

  // The next grid cell of a channel; the value of an unseen one is ignored. was_outlier: the sample before it is known
  // to be one.
  void push(std::size_t channel, double value, bool seen, bool was_outlier) noexcept;
  // After the cell's last channel: decides on the samples before it, and follows the stream.
  void settle() noexcept;
  // The sample before the newest is an outlier, and was not known to be one.
  [[nodiscard]] bool found(std::size_t channel) const noexcept {
    return channels_[channel].is_outlier != 0 && channels_[channel].was_outlier == 0;
  }
  // The newest sample departs far from its prediction while no other channel does, and nothing has confirmed it yet.
  [[nodiscard]] bool is_doubtful(std::size_t channel) const noexcept;
  void restart() noexcept;

  // Trivially copyable: part of a state that is saved.
  struct Channel {
    std::array<double, kHistory> value = {};              // the newest samples in order, outliers replaced
    std::array<double, kOrder> product = {}, power = {};  // of the lattice's stages: fading sums
    std::array<double, kOrder> backward = {};             // their backward errors of the sample before
    std::array<double, kOrder + 1> filter = {};           // second differences to innovation
    std::array<double, kMemory> innovation = {};          // sizes, a ring
    double before = 0.0, newest = 0.0;                    // innovations of the last two samples
    std::uint32_t n_values = 0, n_followed = 0, n_innovations = 0, i_next = 0;
    std::uint32_t was_outlier = 0, is_outlier = 0;
  };
  [[nodiscard]] std::vector<Channel>& state() noexcept { return channels_; }
  [[nodiscard]] const std::vector<Channel>& state() const noexcept { return channels_; }
  [[nodiscard]] bool is_consistent() const noexcept;

 private:
  [[nodiscard]] bool is_alone(std::size_t channel, bool with_before) const noexcept;

  std::vector<Channel> channels_;
};

}  // namespace core

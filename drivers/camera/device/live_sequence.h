#pragma once

#include <cstdint>

namespace drivers {

// Frame numbers of a live camera: 64 bits, never decreasing, with a jump for every missing frame. The device's own
// number has 32 bits and wraps, restarts with the device, and may not count at all.
class LiveSequence {
 public:
  explicit LiveSequence(double rate_hz) noexcept : rate_hz_(rate_hz) {}

  struct Step {
    std::uint64_t sequence = 0;
    bool gap_before = false;
  };
  // Where the device's number decreased, stayed the same, or the stream was interrupted, the elapsed time is used
  // instead.
  [[nodiscard]] Step next(std::uint32_t device_sequence, std::int64_t t_ns) noexcept;
  void interrupted() noexcept { is_interrupted_ = true; }

 private:
  double rate_hz_;
  bool has_last_ = false;
  bool is_interrupted_ = false;
  std::uint32_t last_device_ = 0;
  std::int64_t last_t_ns_ = 0;
  std::uint64_t sequence_ = 0;
};

}  // namespace drivers

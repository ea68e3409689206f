#pragma once

#include <cstdint>

namespace drivers {

// Frame numbers of a live camera: 64 bits, without a step back, with a jump for every frame that is missing. The device
// counts with 32 bits that wrap, begins anew when it is restarted, and may not count at all.
class LiveSequence {
 public:
  explicit LiveSequence(double rate_hz) noexcept : rate_hz_(rate_hz) {}

  struct Step {
    std::uint64_t sequence = 0;
    bool gap_before = false;
  };
  // Where the device's number went back, stood still, or the stream was interrupted: by the time that has passed.
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

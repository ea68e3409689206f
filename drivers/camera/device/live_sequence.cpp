#include "drivers/camera/device/live_sequence.h"

#include <algorithm>
#include <cmath>

namespace drivers {

LiveSequence::Step LiveSequence::next(std::uint32_t device_sequence, std::int64_t t_ns) noexcept {
  Step step;
  if (has_last_) {
    const std::uint32_t advance = device_sequence - last_device_;  // modulo 2^32: also correct across a wrap
    const bool counts_on = !is_interrupted_ && advance != 0 && advance < 0x8000'0000U;
    const double periods = static_cast<double>(t_ns - last_t_ns_) * 1e-9 * rate_hz_;
    const auto by_time = static_cast<std::uint64_t>(std::max(1LL, std::llround(std::clamp(periods, 0.0, 1e15))));
    const std::uint64_t by = counts_on ? advance : by_time;
    sequence_ += by;
    step.gap_before = is_interrupted_ || by > 1;
  }
  step.sequence = sequence_;
  has_last_ = true;
  is_interrupted_ = false;
  last_device_ = device_sequence;
  last_t_ns_ = t_ns;
  return step;
}

}  // namespace drivers

#pragma once

#include <cstdint>

namespace drivers {

// A device's stamps are on a clock that its documentation names and its driver may not keep to (V4L2: usually
// CLOCK_MONOTONIC; libcamera: CLOCK_BOOTTIME; uvcvideo can be told CLOCK_REALTIME; some stamp with a counter of their
// own). The first stamp is compared with all of them; frames then carry CLOCK_MONOTONIC.
class StampClock {
 public:
  enum class Kind : std::uint8_t { kUndecided, kMonotonic, kBoottime, kRealtime, kArrival };
  struct Now {
    std::int64_t monotonic_ns = 0, boottime_ns = 0, realtime_ns = 0;
  };

  [[nodiscard]] static Now now() noexcept;

  // First call decides: the first clock, in the order above, on which the stamp is at most 1 s old and not more than a
  // quarter of one ahead of `now` (when the frame was had). kArrival: none is; `now` itself then stands for every
  // stamp.
  [[nodiscard]] std::int64_t to_monotonic_ns(std::int64_t stamp_ns, const Now& now) noexcept;
  [[nodiscard]] Kind kind() const noexcept { return kind_; }
  void forget() noexcept { kind_ = Kind::kUndecided; }

 private:
  Kind kind_ = Kind::kUndecided;
};

[[nodiscard]] const char* to_string(StampClock::Kind kind) noexcept;

}  // namespace drivers

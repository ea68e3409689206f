#pragma once

#include <cstdint>

namespace drivers {

// Determines the clock of a device's stamps. Its driver may not use the documented clock (V4L2: usually
// CLOCK_MONOTONIC; libcamera: CLOCK_BOOTTIME; uvcvideo can be set to CLOCK_REALTIME; some use a counter of their
// own). The first stamp is compared with all clocks; frames then carry CLOCK_MONOTONIC.
class StampClock {
 public:
  enum class Kind : std::uint8_t { kUndecided, kMonotonic, kBoottime, kRealtime, kArrival };
  struct Now {
    std::int64_t monotonic_ns = 0, boottime_ns = 0, realtime_ns = 0;
  };

  [[nodiscard]] static Now now() noexcept;

  // The first call decides: the first clock, in the order above, on which the stamp is at most 1 s old and not more
  // than 0.25 s ahead of `now` (the time of receipt). kArrival: there is no such clock; `now` itself then replaces
  // every stamp.
  [[nodiscard]] std::int64_t to_monotonic_ns(std::int64_t stamp_ns, const Now& now) noexcept;
  [[nodiscard]] Kind kind() const noexcept { return kind_; }
  void forget() noexcept { kind_ = Kind::kUndecided; }

 private:
  Kind kind_ = Kind::kUndecided;
};

[[nodiscard]] const char* to_string(StampClock::Kind kind) noexcept;

}  // namespace drivers

#include "drivers/camera/device/stamp_clock.h"

#include <ctime>

namespace drivers {

namespace {

constexpr std::int64_t kOldest_ns = 1'000'000'000;
constexpr std::int64_t kAhead_ns = 250'000'000;  // a driver may stamp with the time at which the frame was due

std::int64_t read_clock(clockid_t clock) noexcept {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}

bool is_near(std::int64_t stamp_ns, std::int64_t now_ns) noexcept {
  return stamp_ns <= now_ns + kAhead_ns && stamp_ns >= now_ns - kOldest_ns;
}

}  // namespace

StampClock::Now StampClock::now() noexcept {
  return {read_clock(CLOCK_MONOTONIC), read_clock(CLOCK_BOOTTIME), read_clock(CLOCK_REALTIME)};
}

std::int64_t StampClock::to_monotonic_ns(std::int64_t stamp_ns, const Now& now) noexcept {
  if (kind_ == Kind::kUndecided) {
    kind_ = is_near(stamp_ns, now.monotonic_ns)  ? Kind::kMonotonic
            : is_near(stamp_ns, now.boottime_ns) ? Kind::kBoottime
            : is_near(stamp_ns, now.realtime_ns) ? Kind::kRealtime
                                                 : Kind::kArrival;
  }
  switch (kind_) {
    case Kind::kUndecided:
    case Kind::kMonotonic:
      return stamp_ns;
    case Kind::kBoottime:
      return stamp_ns - (now.boottime_ns - now.monotonic_ns);
    case Kind::kRealtime:  // may be set during the run: uses the present difference, not the first
      return stamp_ns - (now.realtime_ns - now.monotonic_ns);
    case Kind::kArrival:
      break;
  }
  return now.monotonic_ns;
}

const char* to_string(StampClock::Kind kind) noexcept {
  switch (kind) {
    case StampClock::Kind::kUndecided:
      return "a clock not yet known";
    case StampClock::Kind::kMonotonic:
      return "CLOCK_MONOTONIC";
    case StampClock::Kind::kBoottime:
      return "CLOCK_BOOTTIME";
    case StampClock::Kind::kRealtime:
      return "CLOCK_REALTIME";
    case StampClock::Kind::kArrival:
      return "no clock of ours: arrival times are used";
  }
  return "unknown";
}

}  // namespace drivers

#pragma once

#include <atomic>
#include <cstdint>

#include "drivers/camera/camera.h"
#include "drivers/camera/device/stamp_clock.h"

namespace drivers {

// Counters of a device's DeviceTrouble. Written by the capturing thread, read by any; relaxed: each is independent of
// other data.
class TroubleCount {
 public:
  void lost() noexcept {
    if (!is_lost_.exchange(true, std::memory_order_relaxed)) n_interruptions_.fetch_add(1, std::memory_order_relaxed);
  }
  void found() noexcept { is_lost_.store(false, std::memory_order_relaxed); }
  void damaged() noexcept { n_damaged_.fetch_add(1, std::memory_order_relaxed); }
  void clock(StampClock::Kind kind) noexcept {
    has_no_clock_.store(kind == StampClock::Kind::kArrival, std::memory_order_relaxed);
  }
  [[nodiscard]] DeviceTrouble read() const noexcept {
    return {is_lost_.load(std::memory_order_relaxed), n_interruptions_.load(std::memory_order_relaxed),
            n_damaged_.load(std::memory_order_relaxed), has_no_clock_.load(std::memory_order_relaxed)};
  }

 private:
  std::atomic<bool> is_lost_{false}, has_no_clock_{false};
  std::atomic<std::uint64_t> n_interruptions_{0}, n_damaged_{0};
};

}  // namespace drivers

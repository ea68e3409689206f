#pragma once

#include <atomic>
#include <cstdint>

#include "rt/cache_line.h"
#include "rt/latency_histogram.h"

namespace rt {

// Counters of one stage. Written by the stage's own thread, read by any: relaxed is sufficient, because each counter is
// independent of other data.
struct alignas(kCacheLineBytes) StageStats {
  std::atomic<std::uint64_t> n_in{0};
  std::atomic<std::uint64_t> n_out{0};
  std::atomic<std::uint64_t> n_dropped{0};
  std::atomic<std::uint64_t> busy_ns{0};  // sum over steps that worked, including waiting inside them
  std::atomic<std::uint64_t> cpu_ns{0};   // processor time of the stage's thread
  LatencyHistogram step;                  // duration of steps that worked

  // Only the owning thread writes, so load and store need not be one atomic operation.
  static void add(std::atomic<std::uint64_t>& counter, std::uint64_t n = 1) noexcept {
    counter.store(counter.load(std::memory_order_relaxed) + n, std::memory_order_relaxed);
  }
};

}  // namespace rt

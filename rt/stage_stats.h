#pragma once

#include <atomic>
#include <cstdint>

#include "rt/cache_line.h"

namespace rt {

// Counters of one stage. Written by the stage's own thread, read by any: relaxed is enough, because nothing else is
// ordered by them and each is a number on its own.
struct alignas(kCacheLineBytes) StageStats {
  std::atomic<std::uint64_t> n_in{0};
  std::atomic<std::uint64_t> n_out{0};
  std::atomic<std::uint64_t> n_dropped{0};
  std::atomic<std::uint64_t> busy_ns{0};  // sum over steps that worked
  std::atomic<std::uint64_t> worst_step_ns{0};

  // Only the owning thread writes, so load and store need not be one operation.
  static void add(std::atomic<std::uint64_t>& counter, std::uint64_t n = 1) noexcept {
    counter.store(counter.load(std::memory_order_relaxed) + n, std::memory_order_relaxed);
  }
  static void raise(std::atomic<std::uint64_t>& counter, std::uint64_t value) noexcept {
    if (counter.load(std::memory_order_relaxed) < value) counter.store(value, std::memory_order_relaxed);
  }
};

}  // namespace rt

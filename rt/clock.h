#pragma once

#include <time.h>

#include <cstdint>

namespace rt {

// CLOCK_MONOTONIC in nanoseconds. Used for latencies and pacing, never for results.
[[nodiscard]] inline std::int64_t monotonic_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

// CLOCK_REALTIME in nanoseconds, as accurate as the computer's clock: for receivers on the ground, never for results.
[[nodiscard]] inline std::int64_t utc_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

// Processor time of the calling thread.
[[nodiscard]] inline std::int64_t thread_cpu_ns() noexcept {
  timespec used{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return std::int64_t{used.tv_sec} * 1'000'000'000 + used.tv_nsec;
}

}  // namespace rt

#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace drivers {

// Delays recorded or simulated frames until their stream time has passed since `start`, on CLOCK_MONOTONIC
// (steady_clock). At full speed `wait` returns at once.
class StreamPacer {
 public:
  explicit StreamPacer(bool realtime) noexcept : realtime_(realtime) {}

  void start();
  // `since_first_ns`: stream time after the first frame. False: `deadline` came first, or `cancel` was called.
  [[nodiscard]] bool wait(std::int64_t since_first_ns, std::chrono::steady_clock::time_point deadline) noexcept;
  void cancel() noexcept;  // any thread

 private:
  const bool realtime_;
  std::mutex mutex_;
  std::condition_variable cancelled_changed_;
  bool cancelled_ = false;
  std::chrono::steady_clock::time_point started_at_;
};

// `timeout` from now; negative counts as zero, more than an hour as an hour (so that the sum cannot overflow).
[[nodiscard]] std::chrono::steady_clock::time_point deadline_after(std::chrono::milliseconds timeout) noexcept;

}  // namespace drivers

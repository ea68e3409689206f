#include "drivers/camera/stream_pacer.h"

#include <algorithm>

namespace drivers {

void StreamPacer::start() {
  const std::lock_guard lock(mutex_);
  started_at_ = std::chrono::steady_clock::now();
  cancelled_ = false;
}

bool StreamPacer::wait(std::int64_t since_first_ns, std::chrono::steady_clock::time_point deadline) noexcept {
  if (!realtime_) return true;
  std::unique_lock lock(mutex_);
  const auto left = std::chrono::nanoseconds(since_first_ns) - (deadline - started_at_);  // no sum that could overflow
  const bool is_due_in_time = left <= std::chrono::nanoseconds(0);
  const auto until = is_due_in_time ? started_at_ + std::chrono::nanoseconds(since_first_ns) : deadline;
  cancelled_changed_.wait_until(lock, until, [this] { return cancelled_; });
  return is_due_in_time && !cancelled_;
}

void StreamPacer::cancel() noexcept {
  {
    const std::lock_guard lock(mutex_);
    cancelled_ = true;
  }
  cancelled_changed_.notify_all();
}

std::chrono::steady_clock::time_point deadline_after(std::chrono::milliseconds timeout) noexcept {
  using std::chrono::milliseconds;
  return std::chrono::steady_clock::now() + std::clamp(timeout, milliseconds(0), milliseconds(3'600'000));
}

}  // namespace drivers

#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

#include "core/types/frame.h"
#include "drivers/camera/camera.h"

namespace drivers {

// Buffer of a few frames between a decoding thread and `Camera::capture`. Slots are built once. It uses a mutex,
// because both sides are meant to wait for each other (a file is lossless), and neither does long work under the lock.
class FrameQueue {
 public:
  using Deadline = std::chrono::steady_clock::time_point;

  FrameQueue(std::size_t n_slots, int width_px, int height_px);

  // Decoding thread. `claim` waits for a free slot; nullptr once the queue is closed.
  [[nodiscard]] core::Frame* claim();
  void publish();
  void finish(CaptureStatus last_status, std::string text);  // no more frames; those published are still delivered

  // Capturing thread. nullptr: `status` contains the reason (timeout, or how the stream ended).
  [[nodiscard]] const core::Frame* front(Deadline deadline, CaptureStatus& status);
  void pop();

  // Any thread: waiting frames are dropped, both sides wake. A status of an end already reached is kept.
  void close(CaptureStatus last_status, std::string text);

  // How the stream ended, for the log; empty until the capturing thread has reached the end.
  [[nodiscard]] std::string end_text() const;

 private:
  [[nodiscard]] bool at_end() const noexcept { return closed_ || (finished_ && n_filled_ == 0); }

  mutable std::mutex mutex_;  // guards all members below except the contents of a slot that one side holds
  std::condition_variable changed_;
  std::vector<core::Frame> slots_;
  std::size_t oldest_ = 0;
  std::size_t n_filled_ = 0;
  bool finished_ = false;
  bool closed_ = false;
  CaptureStatus last_status_ = CaptureStatus::kEndOfStream;
  std::string text_;
};

}  // namespace drivers

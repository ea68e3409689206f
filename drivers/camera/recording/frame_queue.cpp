#include "drivers/camera/recording/frame_queue.h"

#include <utility>

namespace drivers {

FrameQueue::FrameQueue(std::size_t n_slots, int width_px, int height_px) : slots_(n_slots) {
  for (core::Frame& slot : slots_) {
    slot.width_px = width_px;
    slot.height_px = height_px;
    slot.pixels.resize(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px));
  }
}

core::Frame* FrameQueue::claim() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return closed_ || n_filled_ < slots_.size(); });
  return closed_ ? nullptr : &slots_[(oldest_ + n_filled_) % slots_.size()];
}

void FrameQueue::publish() {
  {
    const std::lock_guard lock(mutex_);
    ++n_filled_;
  }
  changed_.notify_all();
}

void FrameQueue::finish(CaptureStatus last_status, std::string text) {
  {
    const std::lock_guard lock(mutex_);
    if (at_end()) return;
    finished_ = true;
    last_status_ = last_status;
    text_ = std::move(text);
  }
  changed_.notify_all();
}

const core::Frame* FrameQueue::front(Deadline deadline, CaptureStatus& status) {
  std::unique_lock lock(mutex_);
  changed_.wait_until(lock, deadline, [this] { return at_end() || n_filled_ > 0; });
  if (at_end()) {
    status = last_status_;
    return nullptr;
  }
  status = n_filled_ > 0 ? CaptureStatus::kFrame : CaptureStatus::kTimeout;
  return n_filled_ > 0 ? &slots_[oldest_] : nullptr;
}

void FrameQueue::pop() {
  {
    const std::lock_guard lock(mutex_);
    oldest_ = (oldest_ + 1) % slots_.size();
    --n_filled_;
  }
  changed_.notify_all();
}

void FrameQueue::close(CaptureStatus last_status, std::string text) {
  {
    const std::lock_guard lock(mutex_);
    if (at_end()) return;
    closed_ = true;
    last_status_ = last_status;
    text_ = std::move(text);
  }
  changed_.notify_all();
}

std::string FrameQueue::end_text() const {
  const std::lock_guard lock(mutex_);
  return at_end() ? text_ : std::string();
}

}  // namespace drivers

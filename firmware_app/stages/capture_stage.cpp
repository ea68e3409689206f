#include "firmware_app/stages/capture_stage.h"

#include <chrono>
#include <utility>

namespace app {

namespace {
constexpr std::chrono::milliseconds kCaptureTimeout{100};
}

CaptureStage::CaptureStage(drivers::Camera& camera, rt::RingWriter<core::Frame> frames, core::Frame first)
    : camera_(camera), frames_(frames), first_(std::move(first)), spare_(first_), lossless_(camera.info().lossless) {
  last_sequence_ = first_.sequence;
}

rt::StepStatus CaptureStage::step() noexcept {
  if (stop_.load(std::memory_order_acquire)) return rt::StepStatus::kFinished;
  return first_delivered_ ? deliver_next() : deliver_first();
}

rt::StepStatus CaptureStage::deliver_first() noexcept {
  core::Frame* slot = frames_.try_claim();
  if (slot == nullptr) return rt::StepStatus::kIdle;
  std::swap(*slot, first_);
  first_delivered_ = true;
  rt::StageStats::add(stats().n_in);
  frames_.publish();
  rt::StageStats::add(stats().n_out);
  return rt::StepStatus::kWorked;
}

rt::StepStatus CaptureStage::deliver_next() noexcept {
  core::Frame* slot = frames_.try_claim();
  if (slot == nullptr && lossless_) return rt::StepStatus::kIdle;
  core::Frame& target = slot != nullptr ? *slot : spare_;
  switch (camera_.capture(target, kCaptureTimeout)) {
    case drivers::CaptureStatus::kTimeout:
      return rt::StepStatus::kWorked;  // the wait was inside: look again at once
    case drivers::CaptureStatus::kEndOfStream:
      return rt::StepStatus::kFinished;
    case drivers::CaptureStatus::kFault:
      return rt::StepStatus::kFault;
    case drivers::CaptureStatus::kFrame:
      break;
  }
  count(target);
  if (slot == nullptr) {
    rt::StageStats::add(stats().n_dropped);
    gap_before_next_ = true;
    return rt::StepStatus::kWorked;
  }
  target.gap_before = target.gap_before || gap_before_next_;
  gap_before_next_ = false;
  frames_.publish();
  rt::StageStats::add(stats().n_out);
  return rt::StepStatus::kWorked;
}

void CaptureStage::count(const core::Frame& frame) noexcept {
  rt::StageStats::add(stats().n_in);
  if (frame.sequence > last_sequence_ + 1) {
    n_missing_.store(n_missing_.load(std::memory_order_relaxed) + frame.sequence - last_sequence_ - 1,
                     std::memory_order_relaxed);
  }
  last_sequence_ = frame.sequence;
}

void CaptureStage::finish() noexcept { frames_.close(); }

}  // namespace app

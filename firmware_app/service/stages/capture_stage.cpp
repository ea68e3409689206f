#include "firmware_app/service/stages/capture_stage.h"

#include <chrono>
#include <utility>

#include "rt/clock.h"

namespace app {

namespace {
constexpr std::chrono::milliseconds kCaptureTimeout{100};
}

CaptureStage::CaptureStage(drivers::Camera& camera, rt::RingWriter<core::Frame> frames, core::Frame first,
                           bool thin_overload)
    : camera_(camera),
      frames_(std::move(frames)),
      first_(std::move(first)),
      lossless_(camera.info().lossless),
      thin_overload_(thin_overload && !lossless_),
      rate_hz_(camera.info().rate_hz),
      overload_(rate_hz_) {
  last_sequence_ = first_.sequence;
  if (!lossless_) spare_ = first_;
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
      watch_camera();
      return rt::StepStatus::kWorked;  // capture() has waited already: call step() again at once
    case drivers::CaptureStatus::kEndOfStream:
      return rt::StepStatus::kFinished;
    case drivers::CaptureStatus::kFault:
      return rt::StepStatus::kFault;
    case drivers::CaptureStatus::kFrame:
      break;
  }
  watch_camera();
  count(target);
  if (!thinning_.newest().keeps(target.sequence)) {  // its slot, if it had one, remains free
    rt::StageStats::add(stats().n_dropped);
    return rt::StepStatus::kWorked;
  }
  watch_overload(target, slot == nullptr);
  if (slot == nullptr) {
    drop(target);
    return rt::StepStatus::kWorked;
  }
  target.gap_before = target.gap_before || gap_before_next_;
  gap_before_next_ = false;
  frames_.publish();
  rt::StageStats::add(stats().n_out);
  return rt::StepStatus::kWorked;
}

void CaptureStage::watch_camera() noexcept {
  const bool is_lost = camera_.trouble().is_lost;
  if (is_lost == camera_was_lost_) return;
  camera_was_lost_ = is_lost;
  if (is_lost) {
    events().write("the camera is lost after frame {}: looking for it", static_cast<std::int64_t>(last_sequence_));
  } else {
    events().write("the camera is back");
  }
}

void CaptureStage::drop(const core::Frame& frame) noexcept {
  rt::StageStats::add(stats().n_dropped);
  if (!gap_before_next_)
    events().write("tracking is behind: frame {} and on dropped", static_cast<std::int64_t>(frame.sequence));
  gap_before_next_ = true;
}

void CaptureStage::watch_overload(const core::Frame& frame, bool dropped) noexcept {
  if (!thin_overload_) return;
  const std::uint32_t stride = overload_.add(dropped);
  if (stride == 0 || !thinning_.change({frame.sequence + 1, stride})) return;
  events().write("overload: every {}th frame is kept from frame {} on", stride,
                 static_cast<std::int64_t>(frame.sequence + 1));
}

void CaptureStage::count(core::Frame& frame) noexcept {
  frame.t_taken_ns = rt::monotonic_ns();
  rt::StageStats::add(stats().n_in);
  if (frame.sequence > last_sequence_ + 1) {
    n_missing_.store(n_missing_.load(std::memory_order_relaxed) + frame.sequence - last_sequence_ - 1,
                     std::memory_order_relaxed);
  }
  last_sequence_ = frame.sequence;
}

void CaptureStage::finish() noexcept { frames_.close(); }

}  // namespace app

#pragma once

#include <atomic>
#include <string>

#include "core/types/frame.h"
#include "drivers/camera/camera.h"
#include "firmware_app/service/stages/thinning.h"
#include "rt/spsc_ring.h"
#include "rt/stage.h"

namespace app {

// camera -> frame ring. A lossless source waits for a free slot; a live one drops the newest frame, counts it, and
// marks the gap on the next. Under sustained overload (OverloadWatch), only every n-th frame is kept from then on, at
// equal spacing; the others are counted as dropped, too, but are not marked as gaps.
class CaptureStage : public rt::Stage {
 public:
  // first: the frame that set-up has already taken from the camera; it enters the ring first.
  // thin_overload: false = no thinning; frames are dropped as the ring fills.
  CaptureStage(drivers::Camera& camera, rt::RingWriter<core::Frame> frames, core::Frame first, bool thin_overload);

  [[nodiscard]] std::string_view name() const noexcept override { return "capture"; }
  [[nodiscard]] rt::StepStatus step() noexcept override;
  void finish() noexcept override;

  // Any thread, signal-safe: capture stops after the present frame. Partner: step().
  void request_stop() noexcept {
    stop_.store(true, std::memory_order_release);
    wakeup().nudge();
  }
  [[nodiscard]] const ThinningSchedule& thinning() const noexcept { return thinning_; }  // any thread
  // Any thread: frames lost before they reached the service.
  [[nodiscard]] std::uint64_t n_missing() const noexcept { return n_missing_.load(std::memory_order_relaxed); }

 private:
  [[nodiscard]] rt::StepStatus deliver_first() noexcept;
  [[nodiscard]] rt::StepStatus deliver_next() noexcept;
  void count(core::Frame& frame) noexcept;
  void drop(const core::Frame& frame) noexcept;
  void watch_camera() noexcept;
  void watch_overload(const core::Frame& frame, bool dropped) noexcept;

  drivers::Camera& camera_;
  rt::RingWriter<core::Frame> frames_;
  core::Frame first_;
  core::Frame spare_;  // receives a frame that finds the ring full; empty for a lossless source, which waits
  bool lossless_;
  bool first_delivered_ = false;
  bool gap_before_next_ = false;
  bool camera_was_lost_ = false;
  std::uint64_t last_sequence_ = 0;
  bool thin_overload_;
  double rate_hz_;
  ThinningSchedule thinning_;
  OverloadWatch overload_;
  std::atomic<bool> stop_{false};
  std::atomic<std::uint64_t> n_missing_{0};  // written here only; relaxed: independent of other data
};

}  // namespace app

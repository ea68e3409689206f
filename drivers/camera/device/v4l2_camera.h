#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "drivers/camera/camera.h"
#include "drivers/camera/device/capture_gate.h"
#include "drivers/camera/device/live_sequence.h"
#include "drivers/camera/device/luma.h"
#include "drivers/camera/device/stamp_clock.h"
#include "drivers/camera/device/trouble_count.h"
#include "drivers/camera/device/v4l2_controls.h"
#include "drivers/camera/device/v4l2_stream.h"

namespace drivers {

struct V4l2CameraConfig {
  std::string source{};  // /dev/video0, or a link to it such as /dev/v4l/by-id/...; empty = the only one attached
  WantedMode mode{};
  double readout_ms = 0.0;  // signed
  core::ReadoutDirection readout_direction = core::ReadoutDirection::kDown;
  double exposure_ms = 0.0;  // 0 = the value of automatic exposure when it is locked
};

// A camera on Linux's video interface (USB, HDMI grabbers, SoC bridges that deliver processed images), streaming into
// memory-mapped buffers; pixels are copied once, from there into the caller's slot.
// Times: the driver's flags state whether its stamp is the start of exposure or the end of the frame (then readout and
// exposure are subtracted); StampClock determines which clock the stamps are on.
// Numbers: the device's sequence; frames that it marks as damaged, short frames and frames that it lost are jumps.
// Faults: a grabber's input without a signal gives kTimeout. If the stream breaks or falls silent, or the camera is
// unplugged, the capturing thread sets it up again, with the same mode and controls, as soon as the camera is back
// under any number; meanwhile `capture` gives kTimeout and `trouble` reports the loss.
class V4l2Camera final : public Camera {
 public:
  explicit V4l2Camera(const V4l2CameraConfig& config);
  ~V4l2Camera() override;

  [[nodiscard]] core::CameraInfo info() const override { return info_; }
  void start() override;  // lets automatic exposure, gain and focus settle for a second, then locks them
  CaptureStatus capture(core::Frame& out, std::chrono::milliseconds timeout) noexcept override;
  void stop() noexcept override;  // any thread
  [[nodiscard]] std::string fault() const override { return fault_; }
  [[nodiscard]] DeviceTrouble trouble() const noexcept override { return trouble_.read(); }

 private:
  using Deadline = V4l2Stream::Deadline;
  using Wait = V4l2Stream::Wait;

  void settle();
  // kTimeout: there was no buffer, or it held no usable frame.
  [[nodiscard]] CaptureStatus take(core::Frame& out) noexcept;
  [[nodiscard]] bool fill(const V4l2Filled& buffer, core::Frame& out) noexcept;
  [[nodiscard]] bool has_signal() noexcept;
  [[nodiscard]] bool is_silent() const noexcept;
  void mark_lost() noexcept;
  void interrupt() noexcept;
  void find_again() noexcept;

  V4l2CameraConfig config_;
  V4l2Stream stream_;
  LumaReader luma_;
  LockedControls locked_;
  core::CameraInfo info_;
  StampClock clock_;
  LiveSequence sequence_{1.0};
  std::string fault_;
  Deadline last_buffer_{};  // time of the last buffer, or of stream set-up
  Deadline last_look_{};    // time of the last check of the input's signal
  bool has_signal_ = true;
  int stop_fd_ = -1;  // event that ends the wait
  CaptureGate gate_;
  TroubleCount trouble_;
};

}  // namespace drivers

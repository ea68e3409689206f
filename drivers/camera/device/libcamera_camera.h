#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "drivers/camera/camera.h"
#include "drivers/camera/device/capture_gate.h"
#include "drivers/camera/device/libcamera_session.h"
#include "drivers/camera/device/live_sequence.h"
#include "drivers/camera/device/stamp_clock.h"
#include "drivers/camera/device/trouble_count.h"
#include "rt/wakeup.h"

namespace drivers {

struct LibcameraCameraConfig {
  LibcameraWishes wishes{};
  double readout_ms = 0.0;  // signed; 0 = as stated by the camera, if it is
  core::ReadoutDirection readout_direction = core::ReadoutDirection::kDown;
};

// A camera of libcamera: CSI sensors behind an image processor, and USB cameras. Pixels are copied once, from the
// request's buffer into the caller's slot; queueing the request again is the only step in which libcamera allocates.
// Times: SensorTimestamp, the start of exposure of the first row, documented to be on CLOCK_BOOTTIME; otherwise the
// buffer's stamp, which is the kernel driver's. StampClock determines which clock the stamps are on.
// Faults: as V4l2Camera: a camera that is gone or silent is searched for by its id and set up again.
class LibcameraCamera final : public Camera {
 public:
  explicit LibcameraCamera(const LibcameraCameraConfig& config);
  ~LibcameraCamera() override;

  [[nodiscard]] core::CameraInfo info() const override { return info_; }
  // Lets exposure, gain and focus settle for a second and locks them. If no rate is requested, the rate is then that of
  // the frames received meanwhile.
  void start() override;
  CaptureStatus capture(core::Frame& out, std::chrono::milliseconds timeout) noexcept override;
  void stop() noexcept override;  // any thread
  [[nodiscard]] std::string fault() const override { return fault_; }
  [[nodiscard]] DeviceTrouble trouble() const noexcept override { return trouble_.read(); }

 private:
  using Deadline = std::chrono::steady_clock::time_point;

  void settle();
  [[nodiscard]] bool is_silent() const noexcept;  // or gone without notice to libcamera
  [[nodiscard]] bool take(const LibcameraSession::Done& done, core::Frame& out) noexcept;
  [[nodiscard]] bool fill(const LibcameraSession::Done& done, core::Frame& out) noexcept;
  void interrupt() noexcept;
  void find_again() noexcept;

  LibcameraCameraConfig config_;
  rt::Wakeup wakeup_;
  LibcameraSession session_;
  core::CameraInfo info_;
  StampClock clock_;
  LiveSequence sequence_{1.0};
  std::string fault_;
  bool lock_controls_ = false;  // true: with the next request
  Deadline last_request_{};     // time of the last request, or of stream set-up
  CaptureGate gate_;
  TroubleCount trouble_;
};

}  // namespace drivers

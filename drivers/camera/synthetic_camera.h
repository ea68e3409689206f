#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "core/simulation/camera/frame_timing.h"
#include "core/simulation/render/renderer.h"
#include "core/simulation/scene.h"
#include "drivers/camera/camera.h"
#include "drivers/camera/stream_pacer.h"

namespace drivers {

struct SyntheticCameraConfig {
  core::simulation::Scene scene;
  bool realtime = false;
};

// A simulated camera that views a simulated structure. Frames are rendered inside `capture`, from the scene alone:
// the same scene gives the same pixels. Frames are delivered as in the scene's timing, with its stamps: a dropped frame
// is a jump of the sequence, unless the scene's stamps do not show it.
class SyntheticCamera final : public Camera {
 public:
  explicit SyntheticCamera(const SyntheticCameraConfig& config);

  [[nodiscard]] core::CameraInfo info() const override { return info_; }
  void start() override;
  CaptureStatus capture(core::Frame& out, std::chrono::milliseconds timeout) noexcept override;
  void stop() noexcept override;
  [[nodiscard]] std::string fault() const override { return fault_; }

 private:
  CaptureStatus fail(std::string text) noexcept;

  core::simulation::Scene scene_;
  core::simulation::Renderer renderer_;
  core::simulation::Renderer::Scratch scratch_;
  core::simulation::FrameTiming timing_;
  core::simulation::DeliveredFrame next_;  // valid while has_next_
  bool has_next_ = false;
  core::CameraInfo info_;
  StreamPacer pacer_;
  std::string fault_;
  std::atomic<bool> stopped_{true};  // written by start and stop, read by capture; no other data depends on it
};

}  // namespace drivers

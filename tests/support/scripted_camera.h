#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "drivers/camera/camera.h"
#include "tests/support/scene_clip.h"

namespace tests {

// Behaviour of the camera. Frames are counted at the source, including lost ones.
struct CameraScript {
  std::uint64_t n_frames = 0;  // then the stream ends
  std::uint64_t first = 0;     // number of the first frame
  bool lossless = true;        // false: does not wait for the service
  bool knows_length = true;
  std::optional<std::uint64_t> fault_at;       // this frame never comes
  std::optional<std::uint64_t> silent_before;  // ... comes late: n_timeouts first
  int n_timeouts = 0;
  std::chrono::microseconds frame_time{0};             // slept in each capture
  std::function<bool(std::uint64_t)> is_lost;          // the source skips it
  std::function<bool(std::uint64_t)> is_dark;          // all pixels 0
  std::function<std::int64_t(std::uint64_t)> time_ns;  // default: frame / rate
};

// Plays a rendered clip repeatedly according to the script.
class ScriptedCamera : public drivers::Camera {
 public:
  ScriptedCamera(std::shared_ptr<const SceneClip> clip, CameraScript script)
      : clip_(std::move(clip)), script_(std::move(script)), info_(clip_->motion.scene().camera_info()) {
    next_ = script_.first;
    info_.lossless = script_.lossless;
    info_.frame_count = script_.knows_length ? script_.n_frames : 0;
    info_.description = "scripted camera";
  }

  [[nodiscard]] core::CameraInfo info() const override { return info_; }
  void start() override {}
  void stop() noexcept override {}
  [[nodiscard]] std::string fault() const override { return fault_; }

  drivers::CaptureStatus capture(core::Frame& out, std::chrono::milliseconds timeout) noexcept override {
    if (next_ == script_.silent_before && n_silent_ < script_.n_timeouts) {
      ++n_silent_;
      std::this_thread::sleep_for(std::min(timeout, std::chrono::milliseconds(5)));
      return drivers::CaptureStatus::kTimeout;
    }
    if (script_.frame_time.count() > 0) std::this_thread::sleep_for(script_.frame_time);
    bool gap = false;
    while (script_.is_lost && next_ < script_.n_frames && script_.is_lost(next_)) {
      ++next_;
      gap = true;
    }
    if (script_.fault_at && next_ >= *script_.fault_at) {
      fault_ = "the cable came off";
      return drivers::CaptureStatus::kFault;
    }
    if (next_ >= script_.n_frames) return drivers::CaptureStatus::kEndOfStream;
    fill(out, gap);
    ++next_;
    return drivers::CaptureStatus::kFrame;
  }

 private:
  void fill(core::Frame& out, bool gap) const {
    const auto& pixels = clip_->frames[next_ % clip_->frames.size()];
    if (script_.is_dark && script_.is_dark(next_)) {
      std::fill(out.pixels.begin(), out.pixels.end(), std::uint8_t{0});
    } else {
      std::copy(pixels.begin(), pixels.end(), out.pixels.begin());
    }
    out.sequence = next_;
    out.t_start_ns =
        script_.time_ns ? script_.time_ns(next_) : std::llround(static_cast<double>(next_) / info_.rate_hz * 1e9);
    out.exposure_ns = info_.exposure_ns;
    out.gap_before = gap;
    out.width_px = info_.width_px;
    out.height_px = info_.height_px;
  }

  std::shared_ptr<const SceneClip> clip_;
  CameraScript script_;
  core::CameraInfo info_;
  std::uint64_t next_ = 0;
  int n_silent_ = 0;
  std::string fault_;
};

}  // namespace tests

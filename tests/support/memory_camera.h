#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "drivers/camera/camera.h"
#include "rt/clock.h"
#include "tests/support/scene_clip.h"

namespace tests {

// Plays frames from memory, forward and backward, so that there is no jump. period_ns > 0: one per period of wall-clock
// time, whether it is captured or not.
struct Play {
  std::uint64_t n_frames = 0;
  std::int64_t period_ns = 0;
  bool lossless = false;
  std::uint64_t loss_seed = 0;  // 0: nothing is lost; else 30 %
};

// Forward to the last frame and backward.
inline const std::vector<std::uint8_t>& played_frame(const SceneClip& clip, std::uint64_t k) {
  const std::uint64_t last = clip.frames.size() - 1, turn = k % std::max<std::uint64_t>(1, 2 * last);
  return clip.frames[std::min(turn, 2 * last - turn)];
}

class MemoryCamera : public drivers::Camera {
 public:
  MemoryCamera(std::shared_ptr<const SceneClip> clip, Play play, double rate_hz)
      : clip_(std::move(clip)), play_(play), info_(clip_->motion.scene().camera_info()) {
    info_.lossless = play.lossless;
    info_.rate_hz = rate_hz;
    info_.frame_count = 0;
    info_.description = "frames in memory";
  }
  [[nodiscard]] core::CameraInfo info() const override { return info_; }
  void start() override { begin_ns_ = rt::monotonic_ns(); }
  void stop() noexcept override {}
  [[nodiscard]] std::string fault() const override { return {}; }
  drivers::CaptureStatus capture(core::Frame& out, std::chrono::milliseconds) noexcept override {
    const std::uint64_t before = next_;
    while (play_.loss_seed != 0 && next_ > 0 && next_ < play_.n_frames && is_lost(next_)) ++next_;
    if (next_ >= play_.n_frames) return drivers::CaptureStatus::kEndOfStream;
    const std::int64_t due_ns = begin_ns_ + static_cast<std::int64_t>(next_) * play_.period_ns;
    while (play_.period_ns > 0 && rt::monotonic_ns() < due_ns) {
      std::this_thread::sleep_for(std::chrono::nanoseconds(std::max<std::int64_t>(1000, due_ns - rt::monotonic_ns())));
    }
    const auto& pixels = played_frame(*clip_, next_);
    std::copy(pixels.begin(), pixels.end(), out.pixels.begin());
    out.sequence = next_;
    out.t_start_ns = static_cast<std::int64_t>(std::llround(static_cast<double>(next_) / info_.rate_hz * 1e9));
    out.gap_before = next_ != before;
    out.width_px = info_.width_px;
    out.height_px = info_.height_px;
    ++next_;
    return drivers::CaptureStatus::kFrame;
  }

 private:
  [[nodiscard]] bool is_lost(std::uint64_t k) const noexcept {
    std::uint64_t x = (k + (play_.loss_seed << 32U)) * 0x9E3779B97F4A7C15U;  // splitmix64
    x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9U;
    x = (x ^ (x >> 27U)) * 0x94D049BB133111EBU;
    return (x ^ (x >> 31U)) % 10 < 3;
  }

  std::shared_ptr<const SceneClip> clip_;
  Play play_;
  core::CameraInfo info_;
  std::uint64_t next_ = 0;
  std::int64_t begin_ns_ = 0;
};

}  // namespace tests

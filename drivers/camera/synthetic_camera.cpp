#include "drivers/camera/synthetic_camera.h"

#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <stdexcept>
#include <utility>

namespace drivers {
namespace {

std::uint64_t count_delivered(core::simulation::FrameTiming timing) {
  core::simulation::DeliveredFrame frame;
  std::uint64_t n = 0;
  while (timing.next(frame)) ++n;
  return n;
}

}  // namespace

SyntheticCamera::SyntheticCamera(const SyntheticCameraConfig& config)
    : scene_(config.scene),
      renderer_(scene_),
      scratch_(renderer_.make_scratch()),
      timing_(scene_),
      info_(scene_.camera_info()),
      pacer_(config.realtime) {
  if (scene_.n_frames() == 0) {
    throw std::invalid_argument(fmt::format("synthetic camera: {} s at {} Hz hold no frame: raise the duration",
                                            scene_.duration_s, scene_.camera.rate_hz));
  }
  info_.frame_count = count_delivered(timing_);
  info_.lossless = !config.realtime;
  info_.description = fmt::format("synthetic scene, seed {}, {:g} s, {} x {} px, {:g} Hz", scene_.seed,
                                  scene_.duration_s, info_.width_px, info_.height_px, info_.rate_hz);
}

void SyntheticCamera::start() {
  timing_.restart();
  has_next_ = timing_.next(next_);
  fault_.clear();
  pacer_.start();
  stopped_ = false;
}

CaptureStatus SyntheticCamera::capture(core::Frame& out, std::chrono::milliseconds timeout) noexcept {
  if (!fault_.empty()) return CaptureStatus::kFault;
  if (stopped_ || !has_next_) return CaptureStatus::kEndOfStream;
  const auto n_pixels = static_cast<std::size_t>(info_.width_px) * static_cast<std::size_t>(info_.height_px);
  if (out.pixels.size() != n_pixels) {
    return fail(fmt::format("synthetic camera: frame slot of {} bytes for images of {} x {} px", out.pixels.size(),
                            info_.width_px, info_.height_px));
  }
  const std::int64_t t_ns = std::llround(next_.stamp_s * 1e9);
  if (!pacer_.wait(t_ns, deadline_after(timeout))) return CaptureStatus::kTimeout;
  try {
    renderer_.render(next_, out.pixels.data(), scratch_);
  } catch (const std::exception& thrown) {
    return fail(fmt::format("synthetic camera: frame {}: {}", next_.number, thrown.what()));
  }
  out.sequence = next_.sequence;
  out.t_start_ns = t_ns;
  out.exposure_ns = info_.exposure_ns;
  out.gap_before = next_.gap_before;
  out.width_px = info_.width_px;
  out.height_px = info_.height_px;
  has_next_ = timing_.next(next_);
  return CaptureStatus::kFrame;
}

CaptureStatus SyntheticCamera::fail(std::string text) noexcept {
  fault_ = std::move(text);
  return CaptureStatus::kFault;
}

void SyntheticCamera::stop() noexcept {
  stopped_ = true;
  pacer_.cancel();
}

}  // namespace drivers

#include "core/simulation/camera/frame_timing.h"

#include <algorithm>

#include "core/simulation/random_stream.h"

namespace core::simulation {

FrameTiming::FrameTiming(const Scene& scene)
    : timing_(scene.timing), rate_hz_(scene.camera.rate_hz), n_frames_(scene.n_frames()), seed_(scene.seed) {}

double FrameTiming::frame_time_s(std::uint64_t number) const noexcept {
  const double even_s = static_cast<double>(number) / rate_hz_;
  if (timing_.jitter_rms_s <= 0.0 || number == 0) return even_s;
  const double widest_s = 0.45 / rate_hz_;
  RandomStream stream(seed_, "time_jitter", number);
  return even_s + std::clamp(timing_.jitter_rms_s * stream.gaussian(), -widest_s, widest_s);
}

bool FrameTiming::dropped(std::uint64_t number) const noexcept {
  return number > 0 && timing_.drop_probability > 0.0 &&
         RandomStream(seed_, "dropped_frame", number).uniform() < timing_.drop_probability;
}

bool FrameTiming::duplicated(std::uint64_t number) const noexcept {
  return number > 0 && timing_.duplicate_probability > 0.0 &&
         RandomStream(seed_, "duplicated_frame", number).uniform() < timing_.duplicate_probability;
}

bool FrameTiming::next(DeliveredFrame& frame) noexcept {
  bool gap = false;
  while (next_number_ < n_frames_ && dropped(next_number_)) {
    ++next_number_;
    gap = true;
  }
  if (next_number_ >= n_frames_) return false;
  const std::uint64_t number = next_number_++;
  if (!duplicated(number)) shown_number_ = number;
  frame.number = shown_number_;
  frame.t_s = frame_time_s(shown_number_);
  frame.sequence = timing_.stamps_tell ? number : n_delivered_;
  frame.stamp_s = timing_.stamps_tell ? frame_time_s(number) : static_cast<double>(n_delivered_) / rate_hz_;
  frame.gap_before = timing_.stamps_tell && gap;
  ++n_delivered_;
  return true;
}

void FrameTiming::restart() noexcept { next_number_ = n_delivered_ = shown_number_ = 0; }

}  // namespace core::simulation

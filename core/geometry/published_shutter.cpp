#include "core/geometry/published_shutter.h"

#include <algorithm>
#include <utility>

namespace core {

namespace {

void subtract(const PublishedShutter::Region& region, Vector2 per_frame, std::span<const double> share,
              std::span<Vector2> motion) noexcept {
  for (std::size_t i = region.begin; i < region.end; ++i) {
    motion[i].u -= share[i] * per_frame.u;
    motion[i].v -= share[i] * per_frame.v;
  }
}

}  // namespace

PublishedShutter::PublishedShutter(ShutterVelocity velocity, std::vector<Region> regions, std::size_t n_points)
    : velocity_(velocity), regions_(std::move(regions)) {
  last_.resize(velocity_ == ShutterVelocity::kCamera ? n_points : regions_.size());
  has_last_.assign(last_.size(), 0);
}

void PublishedShutter::correct(std::uint64_t sequence, std::span<const double> readout_share,
                               std::span<const std::uint8_t> inlier, std::span<Vector2> motion) noexcept {
  const double n_frames = sequence > last_sequence_ ? static_cast<double>(sequence - last_sequence_) : 1.0;
  last_sequence_ = sequence;
  if (velocity_ == ShutterVelocity::kCamera) {
    correct_by_camera(n_frames, readout_share, inlier, motion);
  } else {
    correct_by_region(n_frames, readout_share, inlier, motion);
  }
}

// Mean flow of the points seen in both frames, so that a point that appears or disappears does not change the mean.
void PublishedShutter::correct_by_camera(double n_frames, std::span<const double> share,
                                         std::span<const std::uint8_t> inlier, std::span<Vector2> motion) noexcept {
  Vector2 flow;
  double count = 0.0;
  for (const Region& region : regions_) {
    for (std::size_t i = region.begin; i < region.end; ++i) {
      if (region.follows && inlier[i] != 0 && has_last_[i] != 0) {
        flow = {flow.u + motion[i].u - last_[i].u, flow.v + motion[i].v - last_[i].v};
        count += 1.0;
      }
      if (inlier[i] != 0) last_[i] = motion[i];
      has_last_[i] = inlier[i];
    }
  }
  if (count == 0.0) return;
  const Vector2 per_frame{flow.u / (count * n_frames), flow.v / (count * n_frames)};
  for (const Region& region : regions_) subtract(region, per_frame, share, motion);
}

void PublishedShutter::correct_by_region(double n_frames, std::span<const double> share,
                                         std::span<const std::uint8_t> inlier, std::span<Vector2> motion) noexcept {
  for (std::size_t r = 0; r < regions_.size(); ++r) {
    Vector2 mean;
    double count = 0.0;
    for (std::size_t i = regions_[r].begin; i < regions_[r].end; ++i) {
      if (inlier[i] == 0) continue;
      mean = {mean.u + motion[i].u, mean.v + motion[i].v};
      count += 1.0;
    }
    if (count == 0.0) {
      has_last_[r] = 0;
      continue;
    }
    mean = {mean.u / count, mean.v / count};
    const Vector2 per_frame{(mean.u - last_[r].u) / n_frames, (mean.v - last_[r].v) / n_frames};
    if (has_last_[r] != 0) subtract(regions_[r], per_frame, share, motion);
    last_[r] = mean;
    has_last_[r] = 1;
  }
}

}  // namespace core

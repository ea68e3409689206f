#pragma once

#include <cstdint>
#include <vector>

#include "core/simulation/scene_motion.h"
#include "core/types/track.h"

namespace core::simulation {

struct TrackOptions {
  int points_per_region = 30;
  double noise_px = 0.03;         // Gaussian, per axis, independent between points and frames
  double loss_probability = 0.0;  // of a point in a frame
};

// What a perfect tracker with white noise would report: points fixed to the plates (and the background), each seen at
// the time at which its own row is exposed. A frame is a function of (scene, options, number) alone.
class TrackGenerator {
 public:
  TrackGenerator(const Scene& scene, const TrackOptions& options);  // throws std::invalid_argument

  void generate(std::uint64_t frame, core::TrackFrame& out) const;
  // The same without noise and loss.
  void generate_true(std::uint64_t frame, core::TrackFrame& out) const;

  [[nodiscard]] const SceneMotion& motion() const noexcept { return motion_; }
  [[nodiscard]] const std::vector<SceneRegion>& regions() const noexcept { return regions_; }  // TrackPoint::region

 private:
  struct Material {
    int body;
    std::uint16_t region;
    PlanePoint point;
  };

  SceneMotion motion_;
  TrackOptions options_;
  std::vector<SceneRegion> regions_;
  std::vector<Material> points_;
};

}  // namespace core::simulation

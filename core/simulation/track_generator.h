#pragma once

#include <cstdint>
#include <vector>

#include "core/simulation/camera/frame_timing.h"
#include "core/simulation/camera/light.h"
#include "core/simulation/scene_motion.h"
#include "core/types/track.h"

namespace core::simulation {

// Tracks as reported by a tracker with the errors of TrackParameters: points fixed to the plates (and the background),
// each seen at the time at which its own line is exposed. A frame is a function of (scene, frame) alone.
class TrackGenerator {
 public:
  explicit TrackGenerator(const Scene& scene);  // throws std::invalid_argument

  void generate(const DeliveredFrame& frame, core::TrackFrame& out) const;
  // The same without noise, loss and the tracker's other errors.
  void generate_true(const DeliveredFrame& frame, core::TrackFrame& out) const;

  [[nodiscard]] const SceneMotion& motion() const noexcept { return motion_; }
  [[nodiscard]] const std::vector<SceneRegion>& regions() const noexcept { return regions_; }  // TrackPoint::region
  // Properties of the points: TrackPoint::id is an index into these.
  struct MaterialPoint {
    int body;
    std::uint16_t region;
    PlanePoint point;       // as SceneMotion::see takes it
    double bias_u, bias_v;  // direction of the error by brightness or zoom, unit length
    double noise_px;        // rms per axis
    double stated_px;       // standard deviation stated in TrackPoint::sigma_px
  };
  [[nodiscard]] const std::vector<MaterialPoint>& points() const noexcept { return points_; }
  [[nodiscard]] FrameTiming timing() const { return FrameTiming(motion_.scene()); }  // from frame 0

 private:
  [[nodiscard]] double grown(int body, double t_s) const noexcept;

  SceneMotion motion_;
  Light light_;
  std::vector<SceneRegion> regions_;
  std::vector<MaterialPoint> points_;
};

}  // namespace core::simulation

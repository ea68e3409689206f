#pragma once

#include <vector>

#include "core/simulation/camera/frame_timing.h"
#include "core/simulation/scene_motion.h"
#include "core/types/displacement.h"

namespace core::simulation {

// Displacements as measured by a service without errors of camera and tracker, plus the noise and losses of
// ChannelParameters: each body's motion along its region's axis at the time at which the region's middle row is
// exposed, averaged over the exposure, relative to the first frame. Camera motion is not contained. A sample is a
// function of (scene, frame) alone.
class ChannelGenerator {
 public:
  // stated_readout_s: readout time known to the service, which determines the row delays of channels(). Copies the
  // motion, whose computation is slow for long records.
  ChannelGenerator(const SceneMotion& motion, double stated_readout_s);

  [[nodiscard]] const std::vector<core::ChannelInfo>& channels() const noexcept { return channels_; }
  void generate(const DeliveredFrame& frame, core::DisplacementSample& out) const;
  [[nodiscard]] core::DisplacementSample sample_prototype() const;

  [[nodiscard]] const SceneMotion& motion() const noexcept { return motion_; }
  [[nodiscard]] FrameTiming timing() const { return FrameTiming(motion_.scene()); }  // from frame 0

 private:
  struct Place {
    int body;
    double sign;      // of the world's axis relative to the image's
    double middle_s;  // from the start of the frame to the middle of the exposure of the region's middle row
    double keyframe_mm;
  };
  [[nodiscard]] double along_axis_mm(const Place& place, double t_frame_s) const noexcept;

  SceneMotion motion_;
  std::vector<core::ChannelInfo> channels_;
  std::vector<Place> places_;
  double scale_mm_per_px_;
};

}  // namespace core::simulation

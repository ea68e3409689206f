#pragma once

#include "core/simulation/camera/camera_motion.h"
#include "core/simulation/camera/projection.h"
#include "core/simulation/injected/shimmer.h"
#include "core/simulation/injected/stabiliser.h"
#include "core/simulation/structure/periodic_signal.h"

namespace core::simulation {

// Image effects after projection: refraction by the air, focus breathing, stabilisation.
class ImageWarp {
 public:
  ImageWarp(const Scene& scene, const CameraMotion& camera);

  [[nodiscard]] double breathing(double t_s) const noexcept { return breathing_.at(t_s); }  // relative
  [[nodiscard]] const Shimmer& shimmer() const noexcept { return shimmer_; }
  [[nodiscard]] bool none() const noexcept { return none_; }
  // t_s: when the point's line is exposed; t_frame_s: start of exposure of line 0.
  [[nodiscard]] ImagePoint apply(ImagePoint image, double t_s, double t_frame_s) const noexcept;

 private:
  Shimmer shimmer_;
  PeriodicSignal breathing_;
  Stabiliser stabiliser_;
  ImagePoint principal_, breathes_about_;
  double middle_s_;  // centre of a frame's readout, after its line 0
  bool none_;
};

}  // namespace core::simulation

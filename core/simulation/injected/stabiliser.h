#pragma once

#include "core/simulation/camera/camera_motion.h"
#include "core/simulation/camera/uniform_spline.h"
#include "core/simulation/injected/parameters.h"

namespace core::simulation {

// Effect of StabiliserParameters on the image of a frame. It observes the image's shift at the structure's mean depth
// and its roll, 500 times per second, through a recursive first-order high-pass.
class Stabiliser {
 public:
  Stabiliser() = default;  // none
  Stabiliser(const StabiliserParameters& parameters, const CameraMotion& camera, double alpha_px, double depth_mm,
             double duration_s);

  // About the principal point; the image rotates from +u towards +v.
  struct Warp {
    double u_px = 0.0, v_px = 0.0, turn_rad = 0.0;
  };
  [[nodiscard]] Warp at(double t_s) const noexcept;

 private:
  UniformSpline u_, v_, turn_;
  double later_s_ = 0.0;  // of the splines' zero of time
  bool works_ = false;
};

}  // namespace core::simulation

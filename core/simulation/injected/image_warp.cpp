#include "core/simulation/injected/image_warp.h"

#include <cmath>

#include "core/simulation/camera/drift.h"
#include "core/simulation/random_stream.h"

namespace core::simulation {

ImageWarp::ImageWarp(const Scene& s, const CameraMotion& camera)
    : shimmer_(s.shimmer, s.seed),
      breathing_(drift({s.breathing.corner_hz, 4.0, 20.0 * s.breathing.corner_hz}, s.breathing.rms,
                       RandomStream(s.seed, "breathing"), s.duration_s)),
      stabiliser_(s.stabiliser, camera, s.camera.alpha_px, s.plates[0].z_mm - s.camera.z_mm, s.duration_s),
      principal_{s.camera.cx_px, s.camera.cy_px},
      breathes_about_{s.camera.cx_px + s.breathing.centre_px[0], s.camera.cy_px + s.breathing.centre_px[1]},
      middle_s_(0.5 * (s.camera.readout_s + s.camera.exposure_s)),
      none_(s.shimmer.rms_px <= 0.0 && s.breathing.rms <= 0.0 && s.stabiliser.gain <= 0.0) {}

ImagePoint ImageWarp::apply(ImagePoint image, double t_s, double t_frame_s) const noexcept {
  if (none_) return image;
  const Shimmer::Shift refracted = shimmer_.at(image.u_px, image.v_px, t_s);
  const double grown = breathing_.at(t_s);
  image.u_px += refracted.u_px + grown * (image.u_px - breathes_about_.u_px);
  image.v_px += refracted.v_px + grown * (image.v_px - breathes_about_.v_px);
  const Stabiliser::Warp warp = stabiliser_.at(t_frame_s + middle_s_);
  const double c = std::cos(warp.turn_rad), s = std::sin(warp.turn_rad);
  const double u = image.u_px - principal_.u_px, v = image.v_px - principal_.v_px;
  return {principal_.u_px + warp.u_px + c * u - s * v, principal_.v_px + warp.v_px + s * u + c * v};
}

}  // namespace core::simulation

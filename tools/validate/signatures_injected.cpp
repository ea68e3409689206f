// First-order signatures of the effects in core/simulation/injected, implemented independently of it. Where an effect's
// course is drawn, that course is taken from the scene.
#include <cmath>
#include <complex>

#include "core/types/constants.h"
#include "tools/validate/signature_cases.h"

namespace tools {
namespace {

using core::kTwoPi;
using core::simulation::ImagePoint;
using core::simulation::Scene;

const Scene& scene_of(const Sight& s) { return s.with.motion().scene(); }

ImagePoint flap_signature(const Sight& s) {
  const auto& flap = scene_of(s).flap;
  const double width_mm = scene_of(s).plates[static_cast<std::size_t>(flap.body)].width_mm;
  const bool loose = s.point().body == flap.body && s.point().point.x_mm / width_mm + 0.5 > flap.from_share;
  return {loose ? s.alpha_px() / s.depth_mm * s.with.motion().own().flap_mm(s.t_s) : 0.0, 0.0};
}

ImagePoint rocking_signature(const Sight& s) {
  if (s.point().body < 0) return {};
  const auto& base = scene_of(s).plates[0];
  const double px_mm = s.alpha_px() / s.depth_mm, turn = s.with.motion().own().rocking_rad(s.t_s);
  return with_line_time(
      s, {-turn * (s.alpha_px() * s.y - px_mm * base.y_mm), turn * (s.alpha_px() * s.x - px_mm * base.x_mm)});
}

// The point moves along the line of sight in proportion to its distance from the axis.
ImagePoint torsion_signature(const Sight& s) {
  if (s.point().body < 0) return {};
  const double share = static_cast<double>(s.point().body) / (scene_of(s).n_bodies() - 1);
  const double ahead_mm = s.point().point.x_mm * share * s.with.motion().own().torsion_rad(s.t_s);
  const double px = -s.alpha_px() * ahead_mm / s.depth_mm;
  return with_line_time(s, {px * s.x, px * s.y});
}

ImagePoint sway_signature(const Sight& s) {
  return {s.point().body < 0 ? s.alpha_px() / s.depth_mm * s.with.motion().own().sway_mm(s.t_s) : 0.0, 0.0};
}

// Frozen flow: the pattern at this point was upstream at time zero.
ImagePoint shimmer_signature(const Sight& s) {
  const auto& drift = scene_of(s).shimmer.drift_px_s;
  const auto then =
      s.with.motion().warp().shimmer().at(s.image.u_px - drift[0] * s.t_s, s.image.v_px - drift[1] * s.t_s, 0.0);
  return {then.u_px, then.v_px};
}

ImagePoint breathing_signature(const Sight& s) {
  const Scene& scene = scene_of(s);
  const auto& centre = scene.breathing.centre_px;
  const double grown = s.with.motion().warp().breathing(s.t_s);
  return {grown * (s.image.u_px - scene.camera.cx_px - centre[0]),
          grown * (s.image.v_px - scene.camera.cy_px - centre[1])};
}

// A spectral line of yaw: the frame is moved by gain i f / (corner + i f) of it, as of the frame's middle minus the
// lag.
ImagePoint stabiliser_signature(const Sight& s) {
  const Scene& scene = scene_of(s);
  const double f = scene.rotor.frequency_hz;
  const double t_s = s.frame.t_s + 0.5 * (scene.camera.readout_s + scene.camera.exposure_s) - scene.stabiliser.lag_s;
  const auto yaw = [&](double at_s) { return s.with.motion().camera().deviation(at_s)[4]; };
  const std::complex<double> line(yaw(t_s), yaw(t_s - 0.25 / f));
  const std::complex<double> passed =
      std::complex<double>(0.0, f) / std::complex<double>(scene.stabiliser.corner_hz, f);
  return {scene.stabiliser.gain * s.alpha_px() * (passed * line).real(), 0.0};
}

// The error grows with the camera's approach, in each point's own direction.
ImagePoint template_zoom_signature(const Sight& s) {
  const auto z_mm = [&](double t_s) { return s.with.motion().camera().deviation(t_s)[2]; };
  const double px = scene_of(s).tracks.template_zoom_px * (z_mm(s.t_s) - z_mm(0.0)) / s.depth_mm;
  return {px * s.point().bias_u, px * s.point().bias_v};
}

void slow_line(Scene& s) {
  s.rotor = {};
  s.rotor.frequency_hz = 2.0;
  s.rotor.wander_rms_hz = 0.0;
  s.rotor.yaw_rms_rad = 2e-5;
}

}  // namespace

std::vector<SignatureCase> injected_cases() {
  return {{"tailed hover",
           [](Scene& s) {
             s.tailed_hover.rms_mm = {0.05, 0.05, 0.1};
           },
           camera_signature},
          {"tailed rotation",
           [](Scene& s) {
             s.tailed_hover.rms_rad = {2e-5, 2e-5, 5e-5};
           },
           camera_signature},
          {"gimbal vibration",
           [](Scene& s) {
             s.vibration.rms_rad = {2e-5, 2e-5, 5e-5}, s.vibration.rms_mm = {0.01, 0.01, 0.0};
           },
           camera_signature},
          {"flap", [](Scene& s) { s.flap.rms_mm = 0.1, s.flap.body = 4; }, flap_signature},
          {"rocking", [](Scene& s) { s.rocking.rms_rad = 1e-4; }, rocking_signature},
          {"torsion", [](Scene& s) { s.torsion.rms_rad = 1e-3; }, torsion_signature},
          {"sway", [](Scene& s) { s.sway.rms_mm = 0.1; }, sway_signature},
          {"shimmer", [](Scene& s) { s.shimmer.rms_px = 0.02, s.shimmer.boiling_px_s = 0.0; }, shimmer_signature},
          {"focus breathing",
           [](Scene& s) {
             s.breathing.rms = 1e-4, s.breathing.centre_px = {200.0, -90.0};
           },
           breathing_signature},
          {"stabiliser", [](Scene& s) { s.stabiliser.gain = 0.8; }, stabiliser_signature, slow_line},
          {"template zoom", [](Scene& s) { s.tracks.template_zoom_px = 1.0; }, template_zoom_signature,
           [](Scene& s) { s.hover.z_rms_mm = 5.0; }}};
}

}  // namespace tools

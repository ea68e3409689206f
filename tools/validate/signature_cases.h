#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <numbers>
#include <vector>

#include "core/simulation/track_generator.h"

namespace tools {

// One point in one frame, as in the scene without the effect.
struct Sight {
  const core::simulation::TrackGenerator& without;
  const core::simulation::TrackGenerator& with;
  std::size_t i_point;
  core::simulation::DeliveredFrame frame, frame_with;
  core::simulation::ImagePoint image;
  double x, y, depth_mm;  // ray and distance
  double t_s;             // middle of the exposure of its line

  [[nodiscard]] const core::simulation::TrackGenerator::MaterialPoint& point() const {
    return without.points()[i_point];
  }
  [[nodiscard]] core::simulation::ImagePoint seen_at(double t_frame_s) const {
    return without.motion().see(point().body, point().point, t_frame_s);
  }
  [[nodiscard]] core::simulation::ImagePoint velocity() const {  // px/s
    constexpr double kStep_s = 1e-4;
    const core::simulation::ImagePoint a = seen_at(frame.t_s - kStep_s), b = seen_at(frame.t_s + kStep_s);
    return {(b.u_px - a.u_px) / (2 * kStep_s), (b.v_px - a.v_px) / (2 * kStep_s)};
  }
  [[nodiscard]] core::simulation::ImagePoint acceleration() const {
    constexpr double kStep_s = 1e-3;
    const core::simulation::ImagePoint a = seen_at(frame.t_s - kStep_s), b = seen_at(frame.t_s + kStep_s);
    return {(a.u_px + b.u_px - 2 * image.u_px) / (kStep_s * kStep_s),
            (a.v_px + b.v_px - 2 * image.v_px) / (kStep_s * kStep_s)};
  }
  [[nodiscard]] double alpha_px() const { return without.motion().scene().camera.alpha_px; }
};

// Image motion caused by a small motion of the camera: translation in mm, rotation in rad, zoom.
[[nodiscard]] core::simulation::ImagePoint motion_field(const Sight& sight, const std::array<double, 7>& motion);
// A shift of the image also shifts the line's time: field + velocity readout / height dv, to first order.
[[nodiscard]] core::simulation::ImagePoint with_line_time(const Sight& sight, core::simulation::ImagePoint field);
// Camera motion of the scene with the effect minus that of the one without, at the point's time.
[[nodiscard]] core::simulation::ImagePoint camera_signature(const Sight& sight);

struct SignatureCase {
  const char* effect;
  std::function<void(core::simulation::Scene&)> add;
  std::function<core::simulation::ImagePoint(const Sight&)> signature;
  std::function<void(core::simulation::Scene&)> prepare = {};  // of the scenes with and without it
};
// Of core/simulation/injected.
[[nodiscard]] std::vector<SignatureCase> injected_cases();

}  // namespace tools

#include "core/simulation/camera/light.h"

#include <cmath>
#include <numbers>

#include "core/simulation/camera/drift.h"
#include "core/simulation/random_stream.h"

namespace core::simulation {
namespace {

constexpr double kWanderCorner_hz = 0.02;

}  // namespace

Light::Light(const Scene& scene)
    : constant_(scene.light.gain_rms <= 0.0 && scene.light.flicker_depth <= 0.0),
      gain_(drift({scene.light.gain_corner_hz, 6.0, 10.0 * scene.light.gain_corner_hz}, scene.light.gain_rms,
                  RandomStream(scene.seed, "light_gain"), scene.duration_s)),
      wander_rad_(drift({kWanderCorner_hz, 6.0, 10.0 * kWanderCorner_hz},
                        scene.light.flicker_wander_hz / kWanderCorner_hz, RandomStream(scene.seed, "flicker_wander"),
                        scene.duration_s)),
      flicker_depth_(scene.light.flicker_depth),
      flicker_hz_(scene.light.flicker_hz),
      flicker_phase_rad_(2.0 * std::numbers::pi * RandomStream(scene.seed, "flicker_phase").uniform()) {
  const double half_turn = std::numbers::pi * flicker_hz_ * scene.camera.exposure_s;
  if (half_turn > 1e-9) flicker_depth_ *= std::sin(half_turn) / half_turn;
}

double Light::factor(double t_s) const noexcept {
  if (constant_) return 1.0;
  const double flicker =
      flicker_depth_ * std::cos(2.0 * std::numbers::pi * flicker_hz_ * t_s + flicker_phase_rad_ + wander_rad_.at(t_s));
  return (1.0 + gain_.at(t_s)) * (1.0 + flicker);
}

}  // namespace core::simulation

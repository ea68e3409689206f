#include "tools/validate/trust_shaking.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "core/simulation/camera/recorded_motion.h"
#include "core/simulation/structure/structure_response.h"
#include "core/types/constants.h"
#include "tools/validate/closure_tracks_record.h"
#include "tools/validate/drawn_scene.h"

namespace tools {
namespace {

using core::simulation::Scene;

constexpr double kGrid_hz = 200.0, kDegree = std::numbers::pi / 180.0;
constexpr double kRunIn_s = 20.0;  // until the aircraft's oscillator has forgotten its start

std::size_t n_grid(const Scene& scene) { return static_cast<std::size_t>(scene.duration_s * kGrid_hz) + 1; }

// Force on the last body by the equation of motion, from its neighbours' and its own motion. The storeys' coordinates
// are the bodies' displacements relative to the ground.
std::vector<double> force_on_last_body(const Scene& scene) {
  const core::simulation::StructureResponse response(scene);
  const auto& model = scene.structure;
  const int n = model.n_bodies();
  const auto row = [n](const Eigen::MatrixXd& m) -> Eigen::RowVectorXd { return m.row(n - 1); };
  const double dt = 1.0 / kGrid_hz;
  const auto motion = [&](double t_s) {
    Eigen::VectorXd q(n);
    for (int body = 1; body <= n; ++body)
      q[body - 1] = response.displacement_mm(body, t_s) - response.displacement_mm(0, t_s);
    return q;
  };
  std::vector<double> force;
  Eigen::VectorXd before = motion(-dt), now = motion(0.0);
  for (std::size_t k = 0; k < n_grid(scene); ++k) {
    const Eigen::VectorXd after = motion(static_cast<double>(k + 1) * dt);
    force.push_back(row(model.mass).dot((after - 2.0 * now + before) / (dt * dt)) +
                    row(model.damping).dot((after - before) / (2.0 * dt)) + row(model.stiffness).dot(now));
    before = now, now = after;
  }
  return force;
}

std::vector<double> own_force(const Scene& scene, std::uint64_t seed) {
  Draw draw(seed, "trust_gust_force");
  std::vector<double> force(n_grid(scene));
  for (double& value : force) value = draw.gaussian();
  return force;
}

// Oscillator under the force, scaled to rms_mm. The force runs backwards to the start of the record first.
std::vector<double> held_place(const std::vector<double>& force, double frequency_hz, double damping_ratio,
                               double rms_mm) {
  const double w = core::kTwoPi * frequency_hz, dt = 1.0 / kGrid_hz;
  double place = 0.0, speed = 0.0, squares = 0.0;
  const auto advance = [&](double push) {
    speed += dt * (push - 2.0 * damping_ratio * w * speed - w * w * place);
    place += dt * speed;
  };
  for (std::size_t k = std::min(force.size() - 1, static_cast<std::size_t>(kRunIn_s * kGrid_hz)); k > 0; --k)
    advance(force[k]);
  std::vector<double> out;
  for (const double push : force) {
    advance(push);
    out.push_back(place);
    squares += place * place;
  }
  const double factor = rms_mm / std::sqrt(squares / static_cast<double>(out.size()));
  for (double& value : out) value *= factor;
  return out;
}

// The path of the flight, where one is recorded, on the grid, with the gust to the side.
void add_gust(const std::vector<double>& gust_mm, Scene& scene) {
  auto motion = std::make_shared<core::simulation::RecordedMotion>();
  motion->rate_hz = kGrid_hz;
  motion->x_mm = gust_mm;
  const std::vector<double> rest(gust_mm.size(), 0.0);
  for (auto* axis : {&motion->y_mm, &motion->z_mm, &motion->pitch_rad, &motion->yaw_rad, &motion->roll_rad})
    *axis = rest;
  if (scene.flight) {
    const core::simulation::RecordedPath path(*scene.flight);
    std::vector<double>* axes[] = {&motion->x_mm,      &motion->y_mm,    &motion->z_mm,
                                   &motion->pitch_rad, &motion->yaw_rad, &motion->roll_rad};
    for (int axis = 0; axis < 6; ++axis) {
      for (std::size_t k = 0; k < gust_mm.size(); ++k)
        (*axes[axis])[k] += path.at(axis, static_cast<double>(k) / kGrid_hz);
    }
  }
  scene.flight = std::move(motion);
}

}  // namespace

std::string shake_camera(TrustFlight& flight, Drive drive, std::uint64_t seed) {
  Draw draw(seed, "trust_shaking");
  Scene& scene = flight.job.file.scene;
  scene.vibration.centre_hz = draw.uniform(4.0, 9.0);
  const double gimbal_deg = draw.log_uniform(0.02, 0.1), gust_mm = draw.uniform(1.0, 4.0);
  scene.vibration.rms_rad.fill(gimbal_deg * kDegree);
  scene.hover.pitch_rms_rad = scene.hover.yaw_rms_rad = 1.0 * kDegree;
  const double hold_hz = draw.log_uniform(0.4, 1.2), hold_damping = draw.uniform(0.3, 0.8);
  add_gust(held_place(drive == Drive::kWind ? force_on_last_body(scene) : own_force(scene, seed), hold_hz, hold_damping,
                      gust_mm),
           scene);
  while (!holds_the_view(scene)) scene.camera.alpha_px *= 0.98;
  core::simulation::validate(scene);
  return fmt::format("gimbal {:.2f} Hz {:.3f} deg, gusts {:.2f} mm, focal length {:.0f} px", scene.vibration.centre_hz,
                     gimbal_deg, gust_mm, scene.camera.alpha_px);
}

}  // namespace tools

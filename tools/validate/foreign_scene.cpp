#include "tools/validate/foreign_scene.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "tools/validate/closure_tracks_record.h"
#include "tools/validate/drawn_scene.h"
#include "tools/validate/recorded_hover.h"

namespace tools {
namespace {

using core::simulation::Scene;

constexpr double kShareRecorded = 0.25, kShareFolded = 0.25, kShareBackground = 0.75;
constexpr double kFlightScale = 0.25;  // of the recorded hover, as seen from 2 m
constexpr double kStatedError = 0.3;   // sd of the logarithm

// Returns the factor by which the recorded hover is reduced to fit into the view.
double fit_hover(Scene& scene) {
  double factor = 1.0;
  while (!holds_the_view(scene)) {
    for (double& mm : scene.tailed_hover.rms_mm) mm *= 0.8;
    if (scene.flight == nullptr) continue;
    auto less = std::make_shared<core::simulation::RecordedMotion>(*scene.flight);
    for (auto* axis : {&less->x_mm, &less->y_mm, &less->z_mm}) {
      for (double& mm : *axis) mm *= 0.8;
    }
    scene.flight = less;
    factor *= 0.8;
  }
  return factor;
}

void draw_tails(Scene& scene, Draw draw) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    scene.tailed_hover.rms_mm[axis] = draw.log_uniform(4.0, 25.0);
    scene.tailed_hover.corner_hz[axis] = draw.log_uniform(0.05, 0.5);
    scene.tailed_hover.order[axis] = draw.uniform(3.0, 5.0);
  }
}

// Moves the highest mode to 0.55 ... 0.95 of the frame rate.
void fold_modes(Scene& scene, Draw draw) {
  const double wanted_hz = draw.uniform(0.55, 0.95) * scene.camera.rate_hz;
  const double stiffer = std::pow(wanted_hz / modes_of(scene.structure).back().frequency_hz, 2);
  scene.structure.stiffness *= stiffer;
  scene.structure.damping *= std::sqrt(stiffer);  // keeps the damping ratios
  scene.excitation.band_high_hz = 1.3 * wanted_hz;
}

std::string words_of(const ForeignScene& foreign) {
  const Scene& s = foreign.scene;
  const auto& tails = s.tailed_hover;
  std::string hover = "recorded hover";
  if (s.flight == nullptr) {
    hover = fmt::format("hover {:.1f} {:.1f} {:.1f} mm, corners {:.2f} {:.2f} {:.2f} Hz, f^-{:.1f} {:.1f} {:.1f}",
                        tails.rms_mm[0], tails.rms_mm[1], tails.rms_mm[2], tails.corner_hz[0], tails.corner_hz[1],
                        tails.corner_hz[2], tails.order[0], tails.order[1], tails.order[2]);
  }
  return fmt::format("{}; {} storeys, {}, {} of their modes fold at {:.2f} frames/s; noise {:.4f} px, stated {:.4f}",
                     hover, s.structure.n_bodies(), foreign.shaken, foreign.n_folded, s.camera.rate_hz,
                     s.tracks.noise_px, foreign.stated_px);
}

}  // namespace

bool move_camera(Scene& scene, std::uint64_t seed, const std::string& flight) {
  const bool recorded = Draw(seed, "foreign").uniform(0.0, 1.0) < kShareRecorded && !flight.empty();
  scene.hover.x_rms_mm = scene.hover.y_rms_mm = scene.hover.z_rms_mm = 0.0;
  if (recorded) {
    scene.flight = recorded_hover(flight, kFlightScale, seed, scene.duration_s);
  } else {
    draw_tails(scene, Draw(seed, "foreign_hover"));
  }
  (void)fit_hover(scene);
  return recorded;
}

ForeignScene draw_foreign_scene(std::uint64_t seed, double duration_s, const std::string& flight) {
  Draw draw(seed, "foreign"), noise(seed, "foreign_noise");
  const bool recorded = draw.uniform(0.0, 1.0) < kShareRecorded && !flight.empty();
  const bool folded = draw.uniform(0.0, 1.0)<kShareFolded, wind = draw.sign()> 0.0;
  ForeignScene out;
  out.background = draw.uniform(0.0, 1.0) < kShareBackground;
  out.hover = recorded ? "recorded" : "tails";
  out.shaken = wind ? "wind" : "table";
  out.scene = closure_scene({wind ? Shaking::kWind : Shaking::kGround, true, draw.uniform(0.0, 1.0), duration_s}, seed);
  Scene& scene = out.scene;
  scene.hover.x_rms_mm = scene.hover.y_rms_mm = scene.hover.z_rms_mm = 0.0;
  if (recorded) {
    scene.flight = recorded_hover(flight, kFlightScale, seed, duration_s);
  } else {
    draw_tails(scene, Draw(seed, "foreign_hover"));
  }
  if (folded) fold_modes(scene, Draw(seed, "foreign_fold"));
  scene.tracks.noise_spread = noise.uniform(0.2, 0.7);
  out.stated_px = scene.tracks.noise_px * std::exp(kStatedError * noise.gaussian());
  for (const auto& mode : modes_of(scene.structure)) {
    if (mode.frequency_hz > 0.5 * scene.camera.rate_hz) ++out.n_folded;
  }
  const double factor = fit_hover(scene);
  if (recorded) out.flight_scale = kFlightScale * factor;
  core::simulation::validate(scene);
  out.words = words_of(out);
  return out;
}

core::closure::ObservationRecord foreign_record(const Scene& scene, const ForeignScene& declared) {
  core::closure::ObservationRecord record = observation_record(scene, declared.scene, declared.background);
  for (double& sigma_px : record.sigma_px) sigma_px = declared.stated_px;
  return record;
}

}  // namespace tools

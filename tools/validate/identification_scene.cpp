#include "tools/validate/identification_scene.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "core/simulation/structure/structure_builders.h"
#include "core/types/constants.h"
#include "tools/validate/drawn_scene.h"
#include "tools/validate/identification_match.h"

namespace tools {
namespace {

using core::kTwoPi;
using core::simulation::ExcitationParameters;
using core::simulation::Scene;
using core::simulation::StructureModel;
using Eigen::Index;

constexpr double kDistance_mm = 2000.0;
constexpr double kPlateHeight_mm = 40.0, kPlateWidth_mm = 300.0, kBaseAside_mm = 450.0;

// rms of the roof in a mode under white forces of one density on all bodies; modal masses of unit body masses.
double roof_part(const Eigen::MatrixXd& shapes, Index mode, double frequency_hz) {
  const double w = kTwoPi * frequency_hz;
  return std::abs(shapes(shapes.rows() - 1, mode)) / (shapes.col(mode).norm() * std::pow(w, 1.5));
}

// Forces on the bodies are independent, and therefore so are the modes, whose shapes are orthogonal. A mode whose mass,
// stiffness and viscosity are increased alike keeps frequency and damping ratio and moves less.
StructureModel with_modal_parts(const std::vector<double>& f, const std::vector<double>& damping_ratio) {
  const auto n = static_cast<Index>(f.size());
  const Eigen::MatrixXd shapes = core::simulation::shear_chain_shapes(static_cast<int>(n));
  StructureModel model = core::simulation::from_modes(f, damping_ratio, shapes, std::vector<double>(f.size(), 1.0));
  const double first = roof_part(shapes, 0, f[0]);
  for (Index r = 0; r < n; ++r) {
    const auto mode = static_cast<std::size_t>(r);
    const double heavier = roof_part(shapes, r, f[mode]) / (kModalParts.at(mode) * first);
    model.mass(r, r) *= heavier;
    model.damping(r, r) *= heavier;
    model.stiffness(r, r) *= heavier;
  }
  return model;
}

StructureModel structure_of(const StoreysSetup& setup) {
  std::vector<double> damping = setup.damping_ratio;
  damping.resize(setup.n_storeys(), damping.back());
  if (setup.shaken == StoreysSetup::Shaken::kModalParts) return with_modal_parts(setup.frequency_hz, damping);
  return setup.structure ? *setup.structure : core::simulation::uniform_chain(setup.frequency_hz, damping);
}

std::vector<core::simulation::Plate> stack(const StoreysSetup& setup, int height_px) {
  const int n = static_cast<int>(setup.n_storeys());
  const double step_mm = setup.row_span * height_px / (n - 1);
  std::vector<core::simulation::Plate> plates(setup.n_storeys() + 1);
  for (int body = 0; body <= n; ++body) {
    core::simulation::Plate& plate = plates[static_cast<std::size_t>(body)];
    plate.name = body == 0 ? "base" : "floor" + std::to_string(body);
    plate.x_mm = body == 0 ? kBaseAside_mm : 0.0;
    plate.y_mm = step_mm * (0.5 * (n + 1) - std::max(body, 1));
    plate.z_mm = kDistance_mm;
    plate.width_mm = kPlateWidth_mm;
    plate.height_mm = std::min(kPlateHeight_mm, 0.8 * step_mm);
  }
  return plates;
}

// Of the roof relative to the ground, mm^2, per unit density of acceleration (or of every force).
double roof_variance(const Scene& scene, bool base) {
  const StructureModel& model = scene.structure;
  const ExcitationParameters& band = scene.excitation;
  constexpr double kStep_hz = 2e-3;
  double sum = 0.0;
  for (double f = band.band_low_hz; f < band.band_high_hz; f += kStep_hz) {
    // Reciprocity: the response of the roof to forces on the bodies equals that of the bodies to a force on the roof.
    const Eigen::VectorXcd q = response_at(
        model, kTwoPi * f, model.displacement.row(model.n_bodies() - 1).transpose().cast<std::complex<double>>());
    sum += base ? std::norm((model.influence.transpose().cast<std::complex<double>>() * q)(0))
                : (model.displacement.cast<std::complex<double>>() * q).squaredNorm();
  }
  return sum * kStep_hz;
}

// Whether no two modes appear close to each other, to zero, or to half the rate.
bool stand_apart(const std::vector<double>& frequency_hz, double factor, double rate_hz) {
  constexpr double kApart_hz = 0.15;
  std::vector<double> seen{0.0, 0.5 * rate_hz};
  for (const double f : frequency_hz) {
    const double at = apparent_hz(factor * f, rate_hz);
    if (std::any_of(seen.begin(), seen.end(), [&](double other) { return std::abs(at - other) < kApart_hz; })) {
      return false;
    }
    seen.push_back(at);
  }
  return true;
}

// Factor for all frequencies.
double frequency_factor(const std::vector<double>& frequency_hz, double rate_hz, const DrawnStoreys& limits,
                        std::uint64_t seed) {
  constexpr int kMostTries = 1000;
  const double top = frequency_hz.back() / rate_hz;
  if (top >= limits.least_top && top <= limits.most_top && stand_apart(frequency_hz, 1.0, rate_hz)) return 1.0;
  Draw draw(seed, "highest_mode");
  double factor = 1.0;
  for (int i = 0; i < kMostTries; ++i) {
    factor = draw.uniform(std::max(limits.least_top, 0.8 * std::min(top, limits.most_top)), limits.most_top) / top;
    if (stand_apart(frequency_hz, factor, rate_hz)) break;
  }
  return factor;
}

}  // namespace

const std::vector<double>& storey_frequencies_hz() {
  static const std::vector<double> kFrequencies{1.657, 5.04, 8.14, 10.83, 12.93, 14.34};
  return kFrequencies;
}

Scene storeys_scene(const StoreysSetup& setup, std::uint64_t seed) {
  using Shaken = StoreysSetup::Shaken;
  Scene scene;
  scene.seed = seed;
  scene.duration_s = setup.duration_s;
  scene.camera.alpha_px = kDistance_mm;
  scene.camera.rate_hz = setup.rate_hz;
  scene.camera.readout_s = setup.readout_frames / setup.rate_hz;
  scene.camera.exposure_s = 0.0;
  scene.structure = structure_of(setup);
  scene.excitation.base = setup.shaken == Shaken::kBase ? 1.0 : 0.0;
  scene.excitation.forces = setup.shaken == Shaken::kBase ? 0.05 : (setup.shaken == Shaken::kModalParts ? 1.0 : 0.0);
  scene.excitation.band_high_hz = std::max({20.0, 0.47 * setup.rate_hz, 1.1 * setup.frequency_hz.back()});
  scene.excitation.rms_mm = setup.shaken == Shaken::kNothing ? 0.0 : setup.roof_rms_px;
  scene.plates = stack(setup, scene.camera.height_px);
  scene.hover.x_rms_mm = scene.hover.y_rms_mm = scene.hover.z_rms_mm = 0.0;
  scene.channels.noise_mm = setup.noise_px;
  scene.tracks.noise_spread = setup.noise_spread;
  return scene;
}

StoreysSetup drawn_storeys(StoreysSetup setup, std::uint64_t seed, const DrawnStoreys& limits) {
  const Scene drawn = draw_scene(seed, setup.duration_s).scene;
  const double mm_per_px = drawn.plates.front().z_mm / drawn.camera.alpha_px;
  setup.rate_hz = drawn.camera.rate_hz;
  if (!limits.keeps_readout) setup.readout_frames = drawn.camera.readout_s * setup.rate_hz;
  setup.row_span = (drawn.plates[1].y_mm - drawn.plates.back().y_mm) / mm_per_px / drawn.camera.height_px;
  setup.noise_px = drawn.channels.noise_mm / mm_per_px;
  setup.noise_spread = drawn.tracks.noise_spread;
  setup.roof_rms_px = drawn.excitation.rms_mm / mm_per_px;
  setup.frequency_hz.clear();
  setup.damping_ratio.clear();
  for (const core::simulation::TrueMode& mode : modes_of(drawn.structure)) {
    setup.frequency_hz.push_back(mode.frequency_hz);
    setup.damping_ratio.push_back(mode.damping_ratio);
  }
  const double factor = frequency_factor(setup.frequency_hz, setup.rate_hz, limits, seed);
  for (double& f : setup.frequency_hz) f *= factor;
  setup.structure = drawn.structure;
  setup.structure->stiffness *= factor * factor;
  setup.structure->damping *= factor;
  return setup;
}

std::vector<double> peaks_over_noise_db(const Scene& scene) {
  const StructureModel& model = scene.structure;
  const ExcitationParameters& e = scene.excitation;
  const double base = e.base > 0.0 ? std::pow(e.base * e.rms_mm, 2) / roof_variance(scene, true) : 0.0;
  const double force = e.forces > 0.0 ? std::pow(e.forces * e.rms_mm, 2) / roof_variance(scene, false) : 0.0;
  const double noise = 2.0 * scene.channels.noise_mm * scene.channels.noise_mm / scene.camera.rate_hz;
  std::vector<double> peaks_db;
  for (const core::simulation::TrueMode& mode : modes_of(model)) {
    const Eigen::VectorXd shape = mode.displacement.real();
    // Modal coordinate: in the coordinates of the model by least squares, then mass-normalised.
    const Eigen::VectorXd q = model.displacement.colPivHouseholderQr().solve(shape);
    const double w = kTwoPi * mode.frequency_hz, mass = q.dot(model.mass * q);
    const double load = base * std::pow(q.dot(model.influence), 2) + force * shape.squaredNorm();
    const double density = load / std::pow(2.0 * mode.damping_ratio * w * w * mass, 2);
    peaks_db.push_back(10.0 * std::log10(density * shape.cwiseAbs2().maxCoeff() / noise));
  }
  return peaks_db;
}

}  // namespace tools

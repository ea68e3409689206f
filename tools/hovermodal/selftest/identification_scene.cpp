#include "tools/hovermodal/selftest/identification_scene.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/simulation/structure/structure_builders.h"

namespace tools {
namespace {

using core::simulation::ExcitationParameters;
using core::simulation::Scene;
using core::simulation::StructureModel;
using Eigen::Index;

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kDistance_mm = 2000.0;
constexpr double kPlateHeight_mm = 40.0, kPlateWidth_mm = 300.0, kBaseAside_mm = 450.0;

// rms of the roof in a mode under white forces of one density on all bodies; modal masses of unit body masses.
double roof_part(const Eigen::MatrixXd& shapes, Index mode, double frequency_hz) {
  const double w = kTwoPi * frequency_hz;
  return std::abs(shapes(kStoreys - 1, mode)) / (shapes.col(mode).norm() * std::pow(w, 1.5));
}

// Forces on the bodies are independent, and so then are the modes, whose shapes are orthogonal. A mode made heavier,
// stiffer and more viscous alike keeps frequency and damping ratio and moves less.
StructureModel with_modal_parts(double damping_ratio) {
  const std::vector<double>& f = storey_frequencies_hz();
  const Eigen::MatrixXd shapes = core::simulation::shear_chain_shapes(kStoreys);
  StructureModel model = core::simulation::from_modes(f, std::vector<double>(kStoreys, damping_ratio), shapes,
                                                      std::vector<double>(kStoreys, 1.0));
  const double first = roof_part(shapes, 0, f[0]);
  for (Index r = 0; r < kStoreys; ++r) {
    const double heavier =
        roof_part(shapes, r, f[static_cast<std::size_t>(r)]) / (kModalParts[static_cast<std::size_t>(r)] * first);
    model.mass(r, r) *= heavier;
    model.damping(r, r) *= heavier;
    model.stiffness(r, r) *= heavier;
  }
  return model;
}

std::vector<core::simulation::Plate> stack(const StoreysSetup& setup, int height_px) {
  const double step_mm = setup.row_span * height_px / (kStoreys - 1);
  std::vector<core::simulation::Plate> plates(kStoreys + 1);
  for (int body = 0; body <= kStoreys; ++body) {
    core::simulation::Plate& plate = plates[static_cast<std::size_t>(body)];
    plate.name = body == 0 ? "base" : "floor" + std::to_string(body);
    plate.x_mm = body == 0 ? kBaseAside_mm : 0.0;
    plate.y_mm = step_mm * (0.5 * (kStoreys + 1) - std::max(body, 1));
    plate.z_mm = kDistance_mm;
    plate.width_mm = kPlateWidth_mm;
    plate.height_mm = std::min(kPlateHeight_mm, 0.8 * step_mm);
  }
  return plates;
}

// Of the roof against the ground, mm^2, per unit density of acceleration (or of every force).
double roof_variance(const Scene& scene, bool base) {
  const StructureModel& model = scene.structure;
  const ExcitationParameters& band = scene.excitation;
  constexpr double kStep_hz = 2e-3;
  double sum = 0.0;
  for (double f = band.band_low_hz; f < band.band_high_hz; f += kStep_hz) {
    // Reciprocity: what forces on the bodies do to the roof is what a force on the roof does to the bodies.
    const Eigen::VectorXcd q =
        response_at(model, kTwoPi * f, model.displacement.row(kStoreys - 1).transpose().cast<std::complex<double>>());
    sum += base ? std::norm((model.influence.transpose().cast<std::complex<double>>() * q)(0))
                : (model.displacement.cast<std::complex<double>>() * q).squaredNorm();
  }
  return sum * kStep_hz;
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
  scene.structure = setup.shaken == Shaken::kModalParts
                        ? with_modal_parts(setup.damping_ratio)
                        : core::simulation::uniform_chain(storey_frequencies_hz(),
                                                          std::vector<double>(kStoreys, setup.damping_ratio));
  scene.excitation.base = setup.shaken == Shaken::kBase ? 1.0 : 0.0;
  scene.excitation.forces = setup.shaken == Shaken::kBase ? 0.05 : (setup.shaken == Shaken::kModalParts ? 1.0 : 0.0);
  scene.excitation.band_high_hz = std::max(20.0, 0.47 * setup.rate_hz);
  scene.excitation.rms_mm = setup.shaken == Shaken::kNothing ? 0.0 : setup.roof_rms_px;
  scene.plates = stack(setup, scene.camera.height_px);
  scene.hover.x_rms_mm = scene.hover.y_rms_mm = scene.hover.z_rms_mm = 0.0;
  scene.channels.noise_mm = setup.noise_px;
  return scene;
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

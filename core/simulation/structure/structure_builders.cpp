#include "core/simulation/structure/structure_builders.h"

#include <cmath>
#include <numbers>
#include <string>

#include "core/simulation/structure/structure_check.h"
#include "core/types/constants.h"

namespace core::simulation {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

Eigen::VectorXd to_vector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Index>(values.size()));
}

void require_count(const std::string& what, std::size_t n, std::size_t wanted) {
  if (n == wanted) return;
  refuse_structure("number of " + what + " is " + std::to_string(n) + "; give " + std::to_string(wanted));
}

void require_frame(const ShearBuilding& frame) {
  const std::size_t n = frame.mass_kg.size();
  require_structure(n >= 1 && n <= 64, "number of storeys", static_cast<double>(n), "give the masses of 1 to 64");
  require_count("storey stiffnesses", frame.stiffness_n_per_m.size(), n);
  if (!frame.storey_height_mm.empty()) require_count("storey heights", frame.storey_height_mm.size(), n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::string of = " of storey " + std::to_string(i + 1);
    require_positive("mass" + of + " (kg)", frame.mass_kg[i]);
    require_positive("stiffness" + of + " (N/m)", frame.stiffness_n_per_m[i]);
    if (!frame.storey_height_mm.empty()) require_positive("height" + of + " (mm)", frame.storey_height_mm[i]);
  }
  require_structure(std::isfinite(frame.ground_spring_n_per_m) && frame.ground_spring_n_per_m >= 0.0,
                    "spring under the ground storey (N/m)", frame.ground_spring_n_per_m,
                    "give more than 0, or 0 for none");
}

// Includes the softening by gravity and the ground's spring.
std::vector<double> storey_stiffness(const ShearBuilding& frame) {
  std::vector<double> stiffness = frame.stiffness_n_per_m;
  if (frame.ground_spring_n_per_m > 0.0) stiffness[0] = 1.0 / (1.0 / stiffness[0] + 1.0 / frame.ground_spring_n_per_m);
  if (frame.storey_height_mm.empty()) return stiffness;
  double above_kg = 0.0;
  for (std::size_t i = stiffness.size(); i-- > 0;) {
    above_kg += frame.mass_kg[i];
    stiffness[i] -= kStandardGravity_m_s2 * above_kg / (1e-3 * frame.storey_height_mm[i]);
    require_structure(stiffness[i] > 0.0, "stiffness left by gravity in storey " + std::to_string(i + 1) + " (N/m)",
                      stiffness[i], "the storey buckles: give stiffer columns, less mass or a taller storey");
  }
  return stiffness;
}

}  // namespace

StructureModel shear_frame(const ShearBuilding& frame, const Damping& damping) {
  require_frame(frame);
  const std::vector<double> stiffness = storey_stiffness(frame);
  const auto n = static_cast<Index>(stiffness.size());
  StructureModel model;
  model.mass = to_vector(frame.mass_kg).asDiagonal();
  model.stiffness = MatrixXd::Zero(n, n);
  for (Index i = 0; i < n; ++i) {
    const double k = stiffness[static_cast<std::size_t>(i)];
    model.stiffness(i, i) += k;
    if (i == 0) continue;
    model.stiffness(i - 1, i - 1) += k;
    model.stiffness(i, i - 1) = model.stiffness(i - 1, i) = -k;
  }
  model.influence = model.mass.diagonal();
  model.displacement = MatrixXd::Identity(n, n);
  model.tilt = MatrixXd::Zero(n, n);
  set_damping(model, damping);
  validate(model);
  return model;
}

StructureModel from_modes(const std::vector<double>& frequency_hz, const std::vector<double>& damping_ratio,
                          const MatrixXd& shapes, const std::vector<double>& mass_kg, const MatrixXd& tilts) {
  const auto n = static_cast<Index>(frequency_hz.size()), bodies = static_cast<Index>(mass_kg.size());
  require_structure(n >= 1 && n <= 128, "number of modes", static_cast<double>(n), "give 1 to 128 frequencies");
  require_count("damping ratios", damping_ratio.size(), frequency_hz.size());
  if (shapes.rows() != bodies || shapes.cols() != n ||
      (tilts.size() > 0 && (tilts.rows() != bodies || tilts.cols() != n))) {
    refuse_structure("shapes are " + std::to_string(shapes.rows()) + " x " + std::to_string(shapes.cols()) +
                     "; give (tilts too) one row for each of the " + std::to_string(bodies) +
                     " masses and one column for each of the " + std::to_string(n) + " frequencies");
  }
  for (const double mass : mass_kg) require_positive("mass of a body (kg)", mass);
  StructureModel model;
  model.mass = model.damping = model.stiffness = MatrixXd::Zero(n, n);
  model.displacement = shapes;
  model.tilt = tilts.size() > 0 ? tilts : MatrixXd::Zero(bodies, n);
  model.influence = shapes.transpose() * to_vector(mass_kg);
  for (Index r = 0; r < n; ++r) {
    const double f = frequency_hz[static_cast<std::size_t>(r)], zeta = damping_ratio[static_cast<std::size_t>(r)];
    require_structure(f > 0.0 && f <= 1e3, "frequency of mode " + std::to_string(r + 1) + " (Hz)", f, "give 0 to 1000");
    require_structure(zeta >= 1e-5 && zeta <= 0.9, "damping ratio of mode " + std::to_string(r + 1), zeta,
                      "give 0.00001 to 0.9");
    const double w = 2.0 * std::numbers::pi * f;
    model.mass(r, r) = (shapes.col(r).array().square() * to_vector(mass_kg).array()).sum();
    require_structure(model.mass(r, r) > 0.0, "modal mass of mode " + std::to_string(r + 1), model.mass(r, r),
                      "give a shape that moves");
    model.damping(r, r) = 2.0 * zeta * w * model.mass(r, r);
    model.stiffness(r, r) = w * w * model.mass(r, r);
  }
  validate(model);
  return model;
}

StructureModel from_matrices(const MatrixXd& mass_kg, const MatrixXd& damping_n_s_per_m,
                             const MatrixXd& stiffness_n_per_m) {
  const Index n = mass_kg.rows();
  StructureModel model;
  model.mass = mass_kg;
  model.damping = damping_n_s_per_m;
  model.stiffness = stiffness_n_per_m;
  model.displacement = MatrixXd::Identity(n, n);
  model.tilt = MatrixXd::Zero(n, n);
  model.influence = mass_kg.rowwise().sum();
  validate(model);
  return model;
}

}  // namespace core::simulation

#include "tools/validate/closure_structures.h"

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include "core/simulation/structure/structure_builders.h"
#include "tools/validate/drawn_scene.h"

namespace tools {
namespace {

using core::simulation::ModalDamping;
using core::simulation::ShearBuilding;
using core::simulation::StructureModel;
using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kMassless = 1e-7;  // kg, for coordinates without mass
constexpr double kGravity_mm_s2 = 9806.65;

const ModalDamping kDamping{{0.01}};

// Floors of 1 kg on equal columns; storeys of unit height unless stated otherwise.
struct Uniform {
  Index n_storeys = 6;
  double stiffness = 1900.0;  // N/m

  [[nodiscard]] ShearBuilding frame() const {
    ShearBuilding out;
    out.mass_kg.assign(static_cast<std::size_t>(n_storeys), 1.0);
    out.stiffness_n_per_m.assign(out.mass_kg.size(), stiffness);
    return out;
  }
  // The effect of a flexible foundation or column grows with the height of the frame: returns the size that has the
  // same effect as `flexibility` in six storeys, relative to the columns.
  [[nodiscard]] double scaled(double flexibility) const {
    return flexibility * std::pow(6.0 / static_cast<double>(n_storeys), 2);
  }
};

std::vector<double> frequencies(const ShearBuilding& frame) {
  std::vector<double> out;
  for (const auto& mode : modes_of(shear_frame(frame, kDamping))) {
    if (out.size() < frame.mass_kg.size()) out.push_back(mode.frequency_hz);
  }
  return out;
}

MatrixXd shear_stiffness(const Uniform& u) { return shear_frame(u.frame(), kDamping).stiffness; }

// Beam elements of unit height between floors, displacement and rotation of each floor, clamped at the ground.
MatrixXd beam_stiffness(Index n_storeys, double ei) {
  MatrixXd element(4, 4);
  element << 12, 6, -12, 6, 6, 4, -6, 2, -12, -6, 12, -6, 6, 2, -6, 4;
  MatrixXd all = MatrixXd::Zero(2 * n_storeys + 2, 2 * n_storeys + 2);
  for (Index i = 0; i < n_storeys; ++i) all.block(2 * i, 2 * i, 4, 4) += ei * element;
  return all.bottomRightCorner(2 * n_storeys, 2 * n_storeys);
}

std::vector<double> frequencies(Index n_storeys, const MatrixXd& mass, const MatrixXd& stiffness) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(stiffness, mass, Eigen::EigenvaluesOnly);
  std::vector<double> out;
  for (Index r = 0; r < n_storeys; ++r) out.push_back(std::sqrt(solver.eigenvalues()(r)) / (2.0 * std::numbers::pi));
  return out;
}

std::vector<double> with_turning_joints(const Uniform& u, double flexibility) {
  const Index n = u.n_storeys;
  MatrixXd stiffness = beam_stiffness(n, u.stiffness / 12.0);
  MatrixXd mass = kMassless * MatrixXd::Identity(2 * n, 2 * n);
  for (Index i = 0; i < n; ++i) {
    stiffness(2 * i + 1, 2 * i + 1) += u.stiffness / 12.0 / flexibility;
    mass(2 * i, 2 * i) = 1.0;
  }
  return frequencies(n, mass, stiffness);
}

// Adds a coordinate, the rotation of the foundation; a floor moves by its own displacement and its height times
// rotation.
std::vector<double> with_rocking(const Uniform& u, double flexibility) {
  const Index n = u.n_storeys;
  MatrixXd stiffness = MatrixXd::Zero(n + 1, n + 1);
  stiffness.topLeftCorner(n, n) = shear_stiffness(u);
  stiffness(n, n) = u.stiffness / flexibility;
  MatrixXd motion = MatrixXd::Identity(n, n + 1);
  for (Index i = 0; i < n; ++i) motion(i, n) = static_cast<double>(i + 1);
  MatrixXd mass = motion.transpose() * motion;
  mass(n, n) += kMassless;
  return frequencies(n, mass, stiffness);
}

// Shear and bending as separate coordinates, one after the other: a floor moves by their sum.
std::vector<double> with_bending(const Uniform& u, double flexibility) {
  const Index n = u.n_storeys;
  MatrixXd stiffness = MatrixXd::Zero(3 * n, 3 * n);
  stiffness.topLeftCorner(n, n) = shear_stiffness(u);
  stiffness.bottomRightCorner(2 * n, 2 * n) = beam_stiffness(n, u.stiffness / flexibility);
  MatrixXd motion = MatrixXd::Zero(n, 3 * n);
  for (Index i = 0; i < n; ++i) motion(i, i) = motion(i, n + 2 * i) = 1.0;
  const MatrixXd mass = motion.transpose() * motion + kMassless * MatrixXd::Identity(3 * n, 3 * n);
  return frequencies(n, mass, stiffness);
}

// Apparent frequency of an oscillator integrated with average acceleration: angle of its step matrix's eigenvalue.
double integrated_hz(double frequency_hz, double dt_s) {
  const double w2 = std::pow(2.0 * std::numbers::pi * frequency_hz, 2);
  Eigen::Matrix2d left, right;  // of (displacement, velocity)
  left << 1.0, -dt_s / 2.0, w2 * dt_s / 2.0, 1.0;
  right << 1.0, dt_s / 2.0, -w2 * dt_s / 2.0, 1.0;
  const Eigen::Matrix2d step = left.inverse() * right;
  return std::abs(std::arg(std::complex<double>(step.eigenvalues()(0)))) / (2.0 * std::numbers::pi * dt_s);
}

// A departure with this name and the usual size of the figures: drawn within -30 % ... +40 % of it.
void depart(KnownStructure& out, const Uniform& u, Draw& draw) {
  const double factor = draw.log_uniform(0.7, 1.4);
  ShearBuilding frame = u.frame();
  if (out.effect == "ground_storey") {
    frame.ground_spring_n_per_m = factor * u.stiffness;  // in series: half the stiffness
    out.truth = {{"stiffness_ratio", factor / (1.0 + factor)}};
    out.frequency_hz = frequencies(frame);
  } else if (out.effect == "gravity_softening") {
    // Weight over height: a fifth to 0.29 of the ground storey's stiffness (0.3 is the most that codes allow).
    const double per_s2 = draw.uniform(0.2, 0.29) * u.stiffness / static_cast<double>(u.n_storeys);
    frame.storey_height_mm.assign(frame.mass_kg.size(), kGravity_mm_s2 / per_s2);
    out.truth = {{"gravity_over_height", per_s2}};
    out.frequency_hz = frequencies(frame);
  } else if (out.effect == "roof_mass") {
    frame.mass_kg.back() = 1.0 + factor;
    out.truth = {{"mass_ratio", 1.0 + factor}};
    out.frequency_hz = frequencies(frame);
  } else if (out.effect == "joint_rotation") {
    out.truth = {{"joint_flexibility", 0.3 * factor}};
    out.frequency_hz = with_turning_joints(u, 0.3 * factor);
  } else if (out.effect == "base_rocking") {
    out.truth = {{"rocking_flexibility", u.scaled(0.02 * factor)}};
    out.frequency_hz = with_rocking(u, out.truth.front().value);
  } else if (out.effect == "column_bending") {
    out.truth = {{"bending_flexibility", u.scaled(0.02 * factor)}};
    out.frequency_hz = with_bending(u, out.truth.front().value);
  } else {
    throw std::invalid_argument("no structure lacks " + out.effect);
  }
}

}  // namespace

const std::vector<std::string>& known_structures() {
  static const std::vector<std::string> all{"none",           "ground_storey", "gravity_softening", "roof_mass",
                                            "joint_rotation", "base_rocking",  "column_bending",    "integrator"};
  return all;
}

KnownStructure known_structure(const std::string& effect, std::uint64_t seed) {
  Draw draw(seed, "uniform_frame"), own(seed, effect);
  const Uniform u{draw.whole(4, 8), draw.log_uniform(800.0, 4500.0)};
  KnownStructure out{effect, frequencies(u.frame()), {}, effect == "integrator"};
  if (effect == "none") return out;
  if (!out.simulated) {
    depart(out, u, own);
    return out;
  }
  const double dt_s = own.uniform(0.11, 0.15) / out.frequency_hz.back();  // seven to nine steps a period
  for (double& hz : out.frequency_hz) hz = integrated_hz(hz, dt_s);
  out.truth = {{"dt", dt_s}};
  return out;
}

}  // namespace tools

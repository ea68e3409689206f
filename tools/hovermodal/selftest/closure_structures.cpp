#include "tools/hovermodal/selftest/closure_structures.h"

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/simulation/structure/structure_builders.h"

namespace tools {
namespace {

using core::simulation::ModalDamping;
using core::simulation::ShearFrame;
using core::simulation::StructureModel;
using Eigen::Index;
using Eigen::MatrixXd;

constexpr Index kStoreys = 6;
constexpr double kStiffness = 1900.0;  // N/m on 1 kg: modes near those of the paper's frame
constexpr double kMassless = 1e-7;     // kg, of coordinates that carry none

const ModalDamping kDamping{{0.01}};

std::vector<double> frequencies(const StructureModel& model) {
  std::vector<double> out;
  for (const auto& mode : modes_of(model)) {
    if (out.size() < static_cast<std::size_t>(kStoreys)) out.push_back(mode.frequency_hz);
  }
  return out;
}

ShearFrame plain() {
  ShearFrame frame;
  frame.mass_kg.assign(kStoreys, 1.0);
  frame.stiffness_n_per_m.assign(kStoreys, kStiffness);
  return frame;
}

MatrixXd shear_stiffness() { return shear_frame(plain(), kDamping).stiffness; }

// Beam elements of unit height between floors, displacement and rotation of each floor, clamped at the ground.
MatrixXd beam_stiffness(double ei) {
  MatrixXd element(4, 4);
  element << 12, 6, -12, 6, 6, 4, -6, 2, -12, -6, 12, -6, 6, 2, -6, 4;
  MatrixXd all = MatrixXd::Zero(2 * kStoreys + 2, 2 * kStoreys + 2);
  for (Index i = 0; i < kStoreys; ++i) all.block(2 * i, 2 * i, 4, 4) += ei * element;
  return all.bottomRightCorner(2 * kStoreys, 2 * kStoreys);
}

std::vector<double> frequencies(const MatrixXd& mass, const MatrixXd& stiffness) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(stiffness, mass, Eigen::EigenvaluesOnly);
  std::vector<double> out;
  for (Index r = 0; r < kStoreys; ++r) out.push_back(std::sqrt(solver.eigenvalues()(r)) / (2.0 * std::numbers::pi));
  return out;
}

std::vector<double> with_turning_joints(double joint_stiffness) {
  MatrixXd stiffness = beam_stiffness(kStiffness / 12.0);
  MatrixXd mass = kMassless * MatrixXd::Identity(2 * kStoreys, 2 * kStoreys);
  for (Index i = 0; i < kStoreys; ++i) {
    stiffness(2 * i + 1, 2 * i + 1) += joint_stiffness;
    mass(2 * i, 2 * i) = 1.0;
  }
  return frequencies(mass, stiffness);
}

// One more coordinate, the turn of the foundation; a floor moves by its own displacement and its height times the turn.
std::vector<double> with_rocking(double base_stiffness) {
  MatrixXd stiffness = MatrixXd::Zero(kStoreys + 1, kStoreys + 1);
  stiffness.topLeftCorner(kStoreys, kStoreys) = shear_stiffness();
  stiffness(kStoreys, kStoreys) = base_stiffness;
  MatrixXd motion = MatrixXd::Identity(kStoreys, kStoreys + 1);
  for (Index i = 0; i < kStoreys; ++i) motion(i, kStoreys) = static_cast<double>(i + 1);
  MatrixXd mass = motion.transpose() * motion;
  mass(kStoreys, kStoreys) += kMassless;
  return frequencies(mass, stiffness);
}

// Shear and bending as coordinates of their own, one after the other: a floor moves by their sum.
std::vector<double> with_bending(double ei) {
  const Index n = 3 * kStoreys;
  MatrixXd stiffness = MatrixXd::Zero(n, n);
  stiffness.topLeftCorner(kStoreys, kStoreys) = shear_stiffness();
  stiffness.bottomRightCorner(2 * kStoreys, 2 * kStoreys) = beam_stiffness(ei);
  MatrixXd motion = MatrixXd::Zero(kStoreys, n);
  for (Index i = 0; i < kStoreys; ++i) motion(i, i) = motion(i, kStoreys + 2 * i) = 1.0;
  const MatrixXd mass = motion.transpose() * motion + kMassless * MatrixXd::Identity(n, n);
  return frequencies(mass, stiffness);
}

// The turn per step of an oscillator integrated with average acceleration: the angle of its step matrix's eigenvalue.
double integrated_hz(double frequency_hz, double dt_s) {
  const double w2 = std::pow(2.0 * std::numbers::pi * frequency_hz, 2);
  Eigen::Matrix2d left, right;  // of (displacement, velocity)
  left << 1.0, -dt_s / 2.0, w2 * dt_s / 2.0, 1.0;
  right << 1.0, dt_s / 2.0, -w2 * dt_s / 2.0, 1.0;
  const Eigen::Matrix2d step = left.inverse() * right;
  return std::abs(std::arg(std::complex<double>(step.eigenvalues()(0)))) / (2.0 * std::numbers::pi * dt_s);
}

}  // namespace

std::vector<KnownStructure> known_structures() {
  std::vector<KnownStructure> out;
  const auto add = [&](const char* effect, std::vector<double> frequency_hz) {
    out.push_back({effect, std::move(frequency_hz), false});
  };
  add("none", frequencies(shear_frame(plain(), kDamping)));
  ShearFrame frame = plain();
  frame.ground_spring_n_per_m = kStiffness;  // half the stiffness
  add("ground_storey", frequencies(shear_frame(frame, kDamping)));
  frame = plain();
  frame.storey_height_mm.assign(kStoreys, 110.0);
  add("gravity_softening", frequencies(shear_frame(frame, kDamping)));
  frame = plain();
  frame.mass_kg.back() = 2.0;
  add("roof_mass", frequencies(shear_frame(frame, kDamping)));
  add("joint_rotation", with_turning_joints(kStiffness / 12.0 / 0.3));
  add("base_rocking", with_rocking(kStiffness / 0.02));
  add("column_bending", with_bending(kStiffness / 0.02));
  std::vector<double> slow = out.front().frequency_hz;
  for (double& hz : slow) hz = integrated_hz(hz, 0.01);
  out.push_back({"integrator", slow, true});
  return out;
}

}  // namespace tools

#include "core/simulation/structure/structure_model.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

#include "core/simulation/structure/modal_form.h"
#include "core/simulation/structure/structure_check.h"

namespace core::simulation {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr int kMostBodies = 64, kMostCoordinates = 128;
constexpr double kLeastDamping = 1e-10;  // ratio; rounding alone gives an undamped pole either sign

[[noreturn]] void refuse(const std::string& what) { refuse_structure(what); }

void require_square(const MatrixXd& matrix, Index n, const char* name) {
  if (matrix.rows() != n || matrix.cols() != n) {
    refuse(std::string(name) + " is " + std::to_string(matrix.rows()) + " x " + std::to_string(matrix.cols()) +
           "; give " + std::to_string(n) + " x " + std::to_string(n) + ", as the mass");
  }
  if (!matrix.allFinite()) refuse(std::string(name) + " holds a value that is no number");
  if ((matrix - matrix.transpose()).cwiseAbs().maxCoeff() > 1e-9 * matrix.cwiseAbs().maxCoeff()) {
    refuse(std::string(name) + " is not symmetric");
  }
}

void require_shapes(const StructureModel& model) {
  const Index n = model.mass.rows();
  if (model.n_bodies() < 1 || model.n_bodies() > kMostBodies) {
    refuse("number of bodies is " + std::to_string(model.n_bodies()) + "; give 1 to " + std::to_string(kMostBodies));
  }
  if (model.influence.size() != n || model.displacement.cols() != n || model.tilt.cols() != n ||
      model.tilt.rows() != model.displacement.rows()) {
    refuse("influence, displacement or tilt do not fit the " + std::to_string(n) + " coordinates");
  }
  if (!model.influence.allFinite() || !model.displacement.allFinite() || !model.tilt.allFinite()) {
    refuse("influence, displacement or tilt hold a value that is no number");
  }
}

}  // namespace

void validate(const StructureModel& model) {
  const Index n = model.mass.rows();
  if (n < 1 || n > kMostCoordinates) {
    refuse("number of coordinates is " + std::to_string(n) + "; give 1 to " + std::to_string(kMostCoordinates));
  }
  require_square(model.mass, n, "mass");
  require_square(model.damping, n, "damping");
  require_square(model.stiffness, n, "stiffness");
  require_shapes(model);
  if (model.mass.llt().info() != Eigen::Success)
    refuse("the mass matrix is not positive definite; give positive masses");
  if (model.stiffness.llt().info() != Eigen::Success) {
    refuse("unstable: the stiffness matrix is not positive definite; raise the stiffness, or lower what softens it");
  }
  const Eigen::VectorXcd poles = poles_of(modal_form(model.mass, model.damping, model.stiffness)).s;
  for (const std::complex<double>& pole : poles) {
    if (pole.real() <= -kLeastDamping * std::abs(pole)) continue;
    refuse("unstable: the pole at " + std::to_string(std::abs(pole) / (2.0 * std::numbers::pi)) +
           " Hz does not decay; give every mode a positive damping");
  }
}

std::vector<TrueMode> modes_of(const StructureModel& model) {
  const Poles poles = poles_of(modal_form(model.mass, model.damping, model.stiffness));
  std::vector<TrueMode> modes;
  for (Index i = 0; i < poles.s.size(); ++i) {
    const std::complex<double> pole = poles.s(i);
    if (pole.imag() <= 1e-9 * std::abs(pole)) continue;
    const Eigen::VectorXcd q = poles.shapes.col(i);
    TrueMode mode{std::abs(pole) / (2.0 * std::numbers::pi), -pole.real() / std::abs(pole), model.displacement * q,
                  model.tilt * q};
    Index largest = 0;
    mode.displacement.cwiseAbs().maxCoeff(&largest);
    const std::complex<double> scale = mode.displacement(largest);
    const double most = model.displacement.cwiseAbs().maxCoeff() * q.cwiseAbs().maxCoeff();
    if (std::abs(scale) <= 1e-9 * most) continue;  // moves nothing that is seen
    mode.displacement /= scale;
    mode.tilt /= scale;
    modes.push_back(std::move(mode));
  }
  std::sort(modes.begin(), modes.end(),
            [](const TrueMode& a, const TrueMode& b) { return a.frequency_hz < b.frequency_hz; });
  return modes;
}

Eigen::VectorXcd response_at(const StructureModel& model, double w, const Eigen::VectorXcd& force) {
  Eigen::MatrixXcd dynamic = (model.stiffness - w * w * model.mass).cast<std::complex<double>>();
  dynamic += std::complex<double>(0.0, w) * model.damping;
  return dynamic.partialPivLu().solve(force);
}

Eigen::MatrixXd shear_chain_shapes(int n_floors) {
  MatrixXd shapes(n_floors, n_floors);
  for (int r = 1; r <= n_floors; ++r) {
    for (int i = 1; i <= n_floors; ++i) {
      shapes(i - 1, r - 1) = std::sin((2 * r - 1) * i * std::numbers::pi / (2 * n_floors + 1));
    }
    Index largest = 0;
    shapes.col(r - 1).cwiseAbs().maxCoeff(&largest);
    const double scale = shapes(largest, r - 1);
    shapes.col(r - 1) /= scale;
  }
  return shapes;
}

// In modal coordinates of unit mass: everything is diagonal, whatever the frequencies.
StructureModel uniform_chain(const std::vector<double>& frequency_hz, const std::vector<double>& damping_ratio) {
  const auto n = static_cast<Index>(frequency_hz.size());
  if (n < 1 || n > kMostBodies || damping_ratio.size() != frequency_hz.size()) {
    refuse("give 1 to " + std::to_string(kMostBodies) + " frequencies and one damping ratio for each");
  }
  StructureModel model;
  model.mass = MatrixXd::Identity(n, n);
  model.damping = model.stiffness = MatrixXd::Zero(n, n);
  model.displacement = shear_chain_shapes(static_cast<int>(n)).colwise().normalized();
  model.tilt = MatrixXd::Zero(n, n);
  model.influence = model.displacement.colwise().sum();
  for (Index r = 0; r < n; ++r) {
    const double f = frequency_hz[static_cast<std::size_t>(r)], zeta = damping_ratio[static_cast<std::size_t>(r)];
    if (!(f > 0.0 && f <= 1e3)) refuse("natural frequency is " + std::to_string(f) + " Hz; give 0 to 1000");
    if (!(zeta > 0.0 && zeta < 0.5)) refuse("damping ratio is " + std::to_string(zeta) + "; give 0.0001 to 0.5");
    const double w = 2.0 * std::numbers::pi * f;
    model.damping(r, r) = 2.0 * zeta * w;
    model.stiffness(r, r) = w * w;
  }
  return model;
}

}  // namespace core::simulation

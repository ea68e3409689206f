#include "core/simulation/structure/modal_form.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <complex>

namespace core::simulation {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXd;

// Rounding leaves about 1e-12 of the damping on the off-diagonal terms.
bool is_diagonal(const MatrixXd& damping) {
  constexpr double kRounding = 1e-10;
  const Eigen::VectorXd level = damping.diagonal().cwiseAbs().cwiseSqrt();
  for (Index r = 0; r < damping.rows(); ++r) {
    for (Index s = 0; s < r; ++s) {
      if (std::abs(damping(r, s)) > kRounding * level(r) * level(s)) return false;
    }
  }
  return true;
}

}  // namespace

ModalForm modal_form(const MatrixXd& mass, const MatrixXd& damping, const MatrixXd& stiffness) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(stiffness, mass);
  ModalForm form;
  form.w = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  form.shapes = solver.eigenvectors();
  form.damping = form.shapes.transpose() * damping * form.shapes;
  form.diagonal = is_diagonal(form.damping);
  if (form.diagonal) form.damping = MatrixXd(form.damping.diagonal().asDiagonal());
  return form;
}

Poles poles_of(const ModalForm& form) {
  const Index n = form.w.size();
  Poles poles{Eigen::VectorXcd(2 * n), Eigen::MatrixXcd(form.shapes.rows(), 2 * n)};
  if (form.diagonal) {
    for (Index r = 0; r < n; ++r) {
      const double decay = 0.5 * form.damping(r, r), w = form.w(r);
      const Complex root = std::sqrt(Complex((decay - w) * (decay + w), 0.0));
      poles.s(2 * r + 1) = -decay - root;
      poles.s(2 * r) = w > 0.0 ? w * w / poles.s(2 * r + 1) : -decay + root;  // slower real pole, no cancellation
      poles.shapes.col(2 * r) = poles.shapes.col(2 * r + 1) = form.shapes.col(r).cast<Complex>();
    }
    return poles;
  }
  // With the state (diag(w) z, z') all terms are of size w: slow poles stay exact next to fast ones.
  MatrixXd state = MatrixXd::Zero(2 * n, 2 * n);
  state.topRightCorner(n, n) = form.w.asDiagonal();
  state.bottomLeftCorner(n, n) = -MatrixXd(form.w.asDiagonal());
  state.bottomRightCorner(n, n) = -form.damping;
  const Eigen::EigenSolver<MatrixXd> solver(state);
  poles.s = solver.eigenvalues();
  const Eigen::MatrixXcd z = form.w.cwiseInverse().asDiagonal() * solver.eigenvectors().topRows(n);
  poles.shapes = form.shapes.cast<Complex>() * z;
  return poles;
}

Eigen::VectorXcd modal_response(const ModalForm& form, double w, const Eigen::VectorXcd& modal_force) {
  if (form.diagonal) {
    Eigen::VectorXcd z(form.w.size());
    for (Index r = 0; r < z.size(); ++r) {
      z(r) = modal_force(r) / Complex((form.w(r) - w) * (form.w(r) + w), w * form.damping(r, r));
    }
    return z;
  }
  Eigen::MatrixXcd dynamic = Complex(0.0, w) * form.damping.cast<Complex>();
  dynamic.diagonal().array() += form.w.array().square() - w * w;
  return dynamic.partialPivLu().solve(modal_force);
}

}  // namespace core::simulation

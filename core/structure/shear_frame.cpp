#include "core/structure/shear_frame.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/linear/symmetric_eigen.h"

namespace core::structure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::size_t at(Index i) noexcept { return static_cast<std::size_t>(i); }

// Adds springs between neighbouring floors, the first to the ground.
void add_storeys(MatrixXd& k, const VectorXd& storey) {
  for (Index i = 0; i < k.rows(); ++i) {
    k(i, i) += storey(i);
    if (i == 0) continue;
    k(i - 1, i - 1) += storey(i);
    k(i, i - 1) -= storey(i);
    k(i - 1, i) -= storey(i);
  }
}

// Columns clamped into rotating floors: the beam element's coupling of displacement and rotation, shear stiffness 12 E
// I / h^3, rotations in units of displacement / h; with rotations condensed, K_uu - f K_ut (f K_tt + C)^-1 K_tu.
void soften_joints(MatrixXd& k, const VectorXd& storey, double mean, double flexibility) {
  const Index n = k.rows();
  MatrixXd coupling = MatrixXd::Zero(n, n), turning = MatrixXd::Zero(n, n);
  for (Index i = 0; i < n; ++i) {
    const double ei = storey(i) / 12.0;  // E I / h^3
    turning(i, i) += 4.0 * ei;
    coupling(i, i) -= 6.0 * ei;  // own displacement, own rotation at the column's top
    if (i == 0) continue;
    turning(i - 1, i - 1) += 4.0 * ei;
    turning(i, i - 1) += 2.0 * ei;
    turning(i - 1, i) += 2.0 * ei;
    coupling(i - 1, i - 1) += 6.0 * ei;
    coupling(i - 1, i) += 6.0 * ei;
    coupling(i, i - 1) -= 6.0 * ei;
  }
  const MatrixXd joints = flexibility * turning + mean / 12.0 * MatrixXd::Identity(n, n);
  k -= flexibility * coupling * joints.llt().solve(coupling.transpose());
}

// In series with k: flexibilities are added.
void add_flexibility(MatrixXd& k, double rocking, double bending, double mean) {
  const Index n = k.rows();
  MatrixXd flexibility = k.llt().solve(MatrixXd::Identity(n, n));
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) {
      const double low = static_cast<double>(std::min(i, j) + 1), high = static_cast<double>(std::max(i, j) + 1);
      flexibility(i, j) += (rocking * low * high + bending * low * low * (3.0 * high - low) / 6.0) / mean;
    }
  }
  k = flexibility.llt().solve(MatrixXd::Identity(n, n));
  k = (0.5 * (k + k.transpose())).eval();
}

// Weight above each storey over its height, relative masses.
VectorXd softening_per_s2(const ShearFrame& frame) {
  VectorXd out(static_cast<Index>(frame.mass.size()));
  double above = 0.0;
  for (Index i = out.size() - 1; i >= 0; --i) {
    above += frame.mass[at(i)];
    out(i) = frame.gravity_over_height_per_s2 * above;
  }
  return out;
}

}  // namespace

MatrixXd stiffness_per_s2(const ShearFrame& frame) {
  const Index n = static_cast<Index>(frame.mass.size());
  const VectorXd storey = Eigen::Map<const VectorXd>(frame.stiffness_per_s2.data(), n);
  const double mean = storey.mean();
  MatrixXd k = MatrixXd::Zero(n, n);
  add_storeys(k, storey);
  if (frame.joint_flexibility > 0.0) soften_joints(k, storey, mean, frame.joint_flexibility);
  if (frame.rocking_flexibility > 0.0 || frame.bending_flexibility > 0.0)
    add_flexibility(k, frame.rocking_flexibility, frame.bending_flexibility, mean);
  if (frame.gravity_over_height_per_s2 != 0.0) add_storeys(k, -softening_per_s2(frame));
  return k;
}

std::optional<FrameModes> frame_modes(const ShearFrame& frame, bool with_shapes) {
  MatrixXd a = stiffness_per_s2(frame);
  const Index n = a.rows();
  VectorXd root(n);
  for (Index i = 0; i < n; ++i) root(i) = std::sqrt(frame.mass[at(i)]);
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) a(i, j) /= root(i) * root(j);
  }
  if (!a.allFinite()) return std::nullopt;
  const SymmetricEigen eigen(std::move(a));
  const VectorXd values = eigen.values().reverse();
  if (!(values(0) > 0.0)) return std::nullopt;
  FrameModes modes;
  modes.frequency_hz = values.cwiseSqrt() / (2.0 * std::numbers::pi);
  if (!with_shapes) return modes;
  modes.shapes = eigen.leading_vectors(n).rowwise().reverse();
  for (Index r = 0; r < n; ++r) {
    auto shape = modes.shapes.col(r);
    shape = shape.cwiseQuotient(root).eval();
    Index largest = 0;
    shape.cwiseAbs().maxCoeff(&largest);
    shape /= double{shape(largest)};
  }
  return modes;
}

double stability_coefficient(const ShearFrame& frame) {
  return softening_per_s2(frame)(0) / frame.stiffness_per_s2.front();
}

}  // namespace core::structure

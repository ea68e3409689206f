#include "core/tracking/moving_parts.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace core {
namespace {

// Motion along the axis of the part.
Eigen::VectorXd along_axis(const MovingPart& part) {
  const double angle = part.proposed.region.axis_deg * std::numbers::pi / 180.0;
  Eigen::VectorXd out(static_cast<Eigen::Index>(part.motion.size()));
  for (std::size_t t = 0; t < part.motion.size(); ++t)
    out[static_cast<Eigen::Index>(t)] = part.motion[t].u * std::cos(angle) + part.motion[t].v * std::sin(angle);
  return out;
}

}  // namespace

void rate_parts(std::vector<MovingPart>& parts) {
  constexpr Eigen::Index kModes = 3;
  constexpr double kHalf = 10.0;  // ratio of motion to noise at which a part has half weight
  const auto n = static_cast<Eigen::Index>(parts.size());
  if (n == 0) return;
  Eigen::MatrixXd motion(static_cast<Eigen::Index>(parts.front().motion.size()), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::VectorXd own = along_axis(parts[static_cast<std::size_t>(i)]);
    const double norm = own.norm();
    motion.col(i) = norm > 0.0 ? Eigen::VectorXd(own / norm) : own;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(motion.transpose() * motion);
  for (Eigen::Index i = 0; i < n; ++i) {
    double shared = 0.0;
    for (Eigen::Index k = std::max<Eigen::Index>(0, n - kModes); k < n; ++k)
      shared += solver.eigenvalues()[k] * solver.eigenvectors()(i, k) * solver.eigenvectors()(i, k);
    MovingPart& part = parts[static_cast<std::size_t>(i)];
    part.proposed.shared = std::clamp(shared, 0.0, 1.0);
    const double ratio = part.proposed.motion_px / std::max(part.proposed.noise_px, 1e-6);
    part.merit = part.proposed.shared * ratio / (ratio + kHalf);
  }
}

double unlike(const MovingPart& a, const MovingPart& b) {
  constexpr double kLeast = 0.05;  // a second region on the same part keeps some value
  const Eigen::VectorXd x = along_axis(a), y = along_axis(b);
  const double all = x.norm() + y.norm();
  return all > 0.0 ? std::clamp((x - y).norm() / all, kLeast, 1.0) : kLeast;
}

}  // namespace core

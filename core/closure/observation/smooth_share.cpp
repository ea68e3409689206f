#include "core/closure/observation/smooth_share.h"

#include <Eigen/QR>
#include <algorithm>

namespace core::closure {

double smooth_share(const Eigen::VectorXd& field, const PointGeometry& g, bool quadratic) {
  const Eigen::Index n = g.x.size();
  Eigen::MatrixXd basis(n, quadratic ? 6 : 3);
  basis.col(0).setOnes();
  basis.col(1) = g.x, basis.col(2) = g.y;
  if (quadratic) {
    basis.col(3) = g.x.cwiseAbs2(), basis.col(4) = g.x.cwiseProduct(g.y), basis.col(5) = g.y.cwiseAbs2();
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(basis);
  const Eigen::MatrixXd values = Eigen::Map<const Eigen::MatrixXd>(field.data(), 2, n).transpose();
  const Eigen::MatrixXd left = values - basis * qr.solve(values);
  return 1.0 - left.squaredNorm() / std::max(values.squaredNorm(), 1e-300);
}

}  // namespace core::closure

#include "core/closure/observation/leave_one_point_out.h"

#include <Eigen/LU>

#include "core/closure/observation/product.h"

namespace core::closure {
namespace {

constexpr double kLeastDeterminant = 1e-4;  // smallest determinant of I - H_jj: below, nothing else predicts point j

// (I - H)^-1. With an added column, H may reach the limit although H without it did not.
Eigen::Matrix2d gain(const Eigen::Matrix2d& hat) {
  const Eigen::Matrix2d freedom = Eigen::Matrix2d::Identity() - hat;
  if (freedom.determinant() < 1e-6) return Eigen::Matrix2d::Identity() * 1e3;
  return freedom.inverse();
}

}  // namespace

LeaveOnePointOut::LeaveOnePointOut(const Eigen::MatrixXd& q) {
  for (Eigen::Index j = 0; j < q.rows() / 2; ++j) {
    const Eigen::Matrix2d hat = q.middleRows(2 * j, 2) * q.middleRows(2 * j, 2).transpose();
    const bool counted = (Eigen::Matrix2d::Identity() - hat).determinant() > kLeastDeterminant;
    hat_.push_back(hat);
    counted_.push_back(counted ? 1 : 0);
    if (!counted) {
      ++n_alone_;
      continue;
    }
    n_values_ += 2;
    noise_ += gain(hat).trace();
  }
}

Eigen::MatrixXd LeaveOnePointOut::errors(const Eigen::Ref<const Eigen::MatrixXd>& residual) const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(residual.rows(), residual.cols());
  for (std::size_t j = 0; j < hat_.size(); ++j) {
    const auto at = static_cast<Eigen::Index>(2 * j);
    if (counted_[j] != 0) out.middleRows(at, 2) = gain(hat_[j]) * residual.middleRows(at, 2);
  }
  return out;
}

double LeaveOnePointOut::squares(const Eigen::MatrixXd& moments) const {
  double sum = 0.0;
  for (std::size_t j = 0; j < hat_.size(); ++j) {
    if (counted_[j] == 0) continue;
    const Eigen::Matrix2d m = gain(hat_[j]);
    const auto at = static_cast<Eigen::Index>(2 * j);
    sum += (m * moments.block<2, 2>(at, at) * m.transpose()).trace();
  }
  return sum;
}

double LeaveOnePointOut::squares_with(const Eigen::MatrixXd& moments, const Eigen::VectorXd& g) const {
  const Eigen::VectorXd sg = moments * g;
  const double gsg = g.dot(sg);
  double sum = 0.0;
  for (std::size_t j = 0; j < hat_.size(); ++j) {
    if (counted_[j] == 0) continue;
    const auto at = static_cast<Eigen::Index>(2 * j);
    const Eigen::Vector2d gj = g.segment<2>(at), sj = sg.segment<2>(at);
    const Eigen::Matrix2d m = gain(hat_[j] + gj * gj.transpose());
    const Eigen::Matrix2d left =
        moments.block<2, 2>(at, at) - gj * sj.transpose() - sj * gj.transpose() + gsg * gj * gj.transpose();
    sum += (m * left * m.transpose()).trace();
  }
  return sum;
}

double LeaveOnePointOut::squares_under(const Eigen::MatrixXd& inverse_covariance,
                                       const Eigen::MatrixXd& moments) const {
  const Eigen::MatrixXd half = product(inverse_covariance, moments);
  double sum = 0.0;
  for (std::size_t j = 0; j < hat_.size(); ++j) {
    if (counted_[j] == 0) continue;
    const auto at = static_cast<Eigen::Index>(2 * j);
    const Eigen::Matrix2d own = inverse_covariance.block<2, 2>(at, at).inverse();
    const Eigen::Matrix2d left = half.middleRows(at, 2) * inverse_covariance.middleCols(at, 2);
    sum += (own * left * own.transpose()).trace();
  }
  return sum;
}

}  // namespace core::closure

#pragma once

#include <Eigen/Core>
#include <vector>

namespace core::closure {

// Leave-one-point-out cross-validation in closed form (PRESS, Allen 1974). A linear fit per frame with orthonormal
// columns Q leaves r = (I - Q Q') z; the prediction error of point j from the others is e_j = (I - H_jj)^-1 r_j.
class LeaveOnePointOut {
 public:
  explicit LeaveOnePointOut(const Eigen::MatrixXd& q);  // 2 points x columns, orthonormal

  // e of residuals (2 points x frames); zero for points that no others predict.
  [[nodiscard]] Eigen::MatrixXd errors(const Eigen::Ref<const Eigen::MatrixXd>& residual) const;
  // Summed squares of e over all frames, from the residuals' second moments (sum of r r').
  [[nodiscard]] double squares(const Eigen::MatrixXd& moments) const;
  // The same with one more orthonormal column g, orthogonal to Q.
  [[nodiscard]] double squares_with(const Eigen::MatrixXd& moments, const Eigen::VectorXd& g) const;
  // Where noise is correlated (universal kriging, Dubrule 1983): e_j = P_jj^-1 (P z)_j, P its inverse covariance beside
  // Q. `moments` may hold parts along Q, which P removes. With P = I - Q Q' it is squares().
  [[nodiscard]] double squares_under(const Eigen::MatrixXd& inverse_covariance, const Eigen::MatrixXd& moments) const;
  // Expected square per value for noise of unit variance, leverage included.
  [[nodiscard]] double noise_variance() const noexcept { return noise_ / static_cast<double>(n_values_); }
  [[nodiscard]] double noise() const noexcept { return noise_; }  // expected squares per frame
  [[nodiscard]] Eigen::Index n_values() const noexcept { return n_values_; }
  [[nodiscard]] Eigen::Index n_alone() const noexcept {
    return n_alone_;
  }  // points that no other points predict; excluded

 private:
  std::vector<Eigen::Matrix2d> hat_;  // H_jj
  std::vector<char> counted_;
  double noise_ = 0.0;
  Eigen::Index n_values_ = 0, n_alone_ = 0;
};

// The errors of a residual's points, computed only for the frames that are asked for. Both arguments must outlive it.
class LeftOutErrors {
 public:
  LeftOutErrors(const LeaveOnePointOut& left_out, const Eigen::MatrixXd& residual)
      : left_out_(left_out), residual_(residual) {}

  [[nodiscard]] Eigen::Index rows() const noexcept { return residual_.rows(); }
  [[nodiscard]] Eigen::Index cols() const noexcept { return residual_.cols(); }
  [[nodiscard]] Eigen::MatrixXd middleCols(Eigen::Index from, Eigen::Index count) const {
    return left_out_.errors(residual_.middleCols(from, count));
  }

 private:
  const LeaveOnePointOut& left_out_;
  const Eigen::MatrixXd& residual_;
};

}  // namespace core::closure

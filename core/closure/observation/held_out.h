#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/closure/observation/leave_one_point_out.h"
#include "core/closure/observation/point_motion_model.h"

namespace core::closure {

// Second moments of a residual, from which all scores of patterns are computed.
struct ResidualMoments {
  std::vector<Eigen::MatrixXd> all, low;  // by parts of the record: stretches of time, every fifth cosine
  Eigen::MatrixXd all_sum, low_sum;
};
// cosines: of the low band (low_cosines()).
[[nodiscard]] ResidualMoments residual_moments(const Eigen::MatrixXd& residual, const Eigen::MatrixXd& cosines);

// Unit vector that explains most of a residual's squares, by power iteration from its largest value; zero if none.
[[nodiscard]] Eigen::VectorXd leading_pattern(const Eigen::MatrixXd& moments);

struct PatternGain {
  double gain = 0.0;  // drop of the held-out squares in noise variances
  bool low_band = false;
};

// Held-out squares of a solved model: points one at a time in closed form (LeaveOnePointOut), above and within the low
// band. Patterns with an amplitude per frame are scored beside the model's own columns.
class HeldOut {
 public:
  explicit HeldOut(const PointMotionModel& model);

  [[nodiscard]] double n_values() const noexcept { return n_values_; }
  [[nodiscard]] double low_share() const noexcept { return low_share_; }  // of the degrees of freedom in time
  [[nodiscard]] double squares(const ResidualMoments& moments) const;
  [[nodiscard]] double noise_variance() const;  // expected per value, for noise of unit variance

  // Of a whitened pattern, in the band where it gains most: both bands only where the upper one, on its own, gains
  // upper_share per value.
  [[nodiscard]] PatternGain of_pattern(const Eigen::VectorXd& beside_low, const Eigen::VectorXd& beside_high,
                                       const ResidualMoments& moments, double upper_share) const;
  // Of the best pattern learned on four fifths of the residual, on the other fifth.
  [[nodiscard]] PatternGain of_learned(const ResidualMoments& moments) const;

 private:
  [[nodiscard]] static double learned_gain(const std::vector<Eigen::MatrixXd>& parts, const Eigen::MatrixXd& sum,
                                           const LeaveOnePointOut& with);

  LeaveOnePointOut high_, low_;
  double low_share_, n_values_;
};

}  // namespace core::closure

#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/closure/observation/leave_one_point_out.h"
#include "core/closure/observation/point_motion_model.h"

namespace core::closure {

// Second moments of a residual, from which all scores of patterns are computed.
struct ResidualMoments {
  std::vector<Eigen::MatrixXd> all, low;  // per part of the record: blocks of time; every fifth cosine
  Eigen::MatrixXd all_sum, low_sum;
};
// cosines: basis of the low band (low_cosines()).
[[nodiscard]] ResidualMoments residual_moments(const Eigen::MatrixXd& residual, const Eigen::MatrixXd& cosines);

// Unit vector that explains most of a residual's squares, by power iteration started at its largest value; zero if
// none.
[[nodiscard]] Eigen::VectorXd leading_pattern(const Eigen::MatrixXd& moments);

struct PatternGain {
  double gain = 0.0;  // decrease of the held-out squares in noise variances
  bool low_band = false;
};

// Held-out squares of a solved model: leave-one-point-out in closed form (LeaveOnePointOut), above and within the low
// band. Patterns with an amplitude per frame are scored by their part outside the model's own columns.
class HeldOut {
 public:
  explicit HeldOut(const PointMotionModel& model);

  [[nodiscard]] double n_values() const noexcept { return n_values_; }
  [[nodiscard]] double low_share() const noexcept { return low_share_; }  // share of the degrees of freedom in time
  [[nodiscard]] double squares(const ResidualMoments& moments) const;
  [[nodiscard]] double noise_variance() const;  // expected square per value for noise of unit variance

  // Gain of a whitened pattern in the band where it gains most. Both bands are used only if the upper band alone gains
  // upper_share per value.
  [[nodiscard]] PatternGain of_pattern(const Eigen::VectorXd& beside_low, const Eigen::VectorXd& beside_high,
                                       const ResidualMoments& moments, double upper_share) const;
  // Gain of the best pattern that is learned on four fifths of the residual and scored on the remaining fifth.
  [[nodiscard]] PatternGain of_learned(const ResidualMoments& moments) const;

 private:
  [[nodiscard]] static double learned_gain(const std::vector<Eigen::MatrixXd>& parts, const Eigen::MatrixXd& sum,
                                           const LeaveOnePointOut& with);

  LeaveOnePointOut high_, low_;
  double low_share_, n_values_;
};

}  // namespace core::closure

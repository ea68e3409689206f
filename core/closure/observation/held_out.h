#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/closure/observation/leave_one_point_out.h"
#include "core/closure/observation/point_motion_model.h"

namespace core::closure {

inline constexpr double kLeastBeside = 1e-3;  // of a pattern's norm that must lie outside the model's columns
inline constexpr double kRungSigmas = 2.0;    // of a gain in one rung by noise: less is none

// Second moments of a residual, from which all scores of patterns are computed.
struct ResidualMoments {
  Eigen::MatrixXd all_sum;
  std::vector<Eigen::MatrixXd> all;      // by stretches of time
  Eigen::MatrixXcd spectrum;             // one side, 2 points x bins; holds all squares
  std::vector<Eigen::MatrixXd> of_rung;  // sums over its bins
};
[[nodiscard]] ResidualMoments residual_moments(const Eigen::MatrixXd& residual, double rate_hz);

// Unit vector that explains most of a residual's squares, by power iteration started at its largest value; zero if
// none.
template <class Scalar>  // moments: symmetric, or complex and Hermitian
[[nodiscard]] Eigen::VectorX<Scalar> leading_pattern(const Eigen::MatrixX<Scalar>& moments) {
  constexpr int kSteps = 60;
  Eigen::Index start = 0;
  moments.diagonal().real().maxCoeff(&start);
  Eigen::VectorX<Scalar> v = moments.col(start);
  for (int step = 0; step < kSteps && v.norm() > 0.0; ++step) v = (moments * v.normalized()).eval();
  return v.norm() > 0.0 ? v.normalized().eval() : v;
}

// A whitened pattern beside the model's columns, of unit norm: in the rungs of the model's added columns, and in
// others.
struct PatternBeside {
  Eigen::VectorXd within, above;
};
[[nodiscard]] PatternBeside pattern_beside(const PointMotionModel& model, const Eigen::VectorXd& whitened);

struct PatternGain {
  double gain = 0.0;  // drop of the held-out squares in noise variances
  RungSet band = 0;   // the rungs in which it is more than noise; kAllRungs: in most of them
};

// Held-out squares of a solved model: points one at a time in closed form (LeaveOnePointOut). Patterns with an
// amplitude per frame are scored beside the model's own columns, rung by rung.
class HeldOut {
 public:
  HeldOut(const PointMotionModel& model, double rate_hz);

  [[nodiscard]] double n_values() const noexcept { return n_values_; }
  [[nodiscard]] const Rungs& rungs() const noexcept { return rungs_; }
  [[nodiscard]] double share_of(RungSet band) const;  // of the degrees of freedom in time
  [[nodiscard]] double freedom_in(std::size_t rung) const { return share_of(RungSet{1} << rung) * n_frames_; }
  [[nodiscard]] double squares(const Eigen::MatrixXd& residual) const;
  // Prediction errors of points left out, outside the band of the model's added columns; 2 points x frames, in sigmas.
  [[nodiscard]] Eigen::MatrixXd errors(const Eigen::MatrixXd& residual) const { return high_.errors(residual); }
  // The same, frame by frame as needed; both this and the residual must outlive it.
  [[nodiscard]] LeftOutErrors errors_of(const Eigen::MatrixXd& residual) const { return {high_, residual}; }
  [[nodiscard]] double noise_variance() const;  // expected per value, for noise of unit variance

  // Of a known pattern, in the rungs where it gains.
  [[nodiscard]] PatternGain of_pattern(const PatternBeside& pattern, const ResidualMoments& moments) const;
  // Of the best pattern learned on four fifths of the residual, on the other fifth: in all rungs, in the slow ones or
  // in the one where most is left.
  [[nodiscard]] PatternGain of_learned(const ResidualMoments& moments) const;
  // The same in a given band.
  [[nodiscard]] double of_learned_in(RungSet band, const ResidualMoments& moments) const;
  // Within the span of these orthonormal columns beside the model.
  [[nodiscard]] double of_learned_in(RungSet band, const ResidualMoments& moments, const Eigen::MatrixXd& span) const;
  [[nodiscard]] Eigen::MatrixXd sum_over(RungSet band, const ResidualMoments& moments) const;

 private:
  [[nodiscard]] bool is_within(std::size_t rung) const noexcept { return holds(band_, rung); }
  [[nodiscard]] double gain_in_rung(std::size_t rung, const PatternBeside& pattern,
                                    const ResidualMoments& moments) const;
  [[nodiscard]] double learned_gain(const std::vector<Eigen::MatrixXd>& parts, const LeaveOnePointOut& with,
                                    const Eigen::MatrixXd& span) const;
  [[nodiscard]] RungSet strongest(const ResidualMoments& moments) const;

  Rungs rungs_;
  RungSet band_;                      // of the model's added columns
  std::vector<Eigen::Index> orders_;  // of the band's cosines
  LeaveOnePointOut high_, low_;
  double within_share_, n_values_, n_frames_;
};

}  // namespace core::closure

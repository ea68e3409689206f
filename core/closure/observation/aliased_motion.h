#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/closure/observation/frame_shift.h"

namespace core::closure {

// Motion above half the frame rate. What repeats at f = nu + n f_s is seen at nu, but its phase runs over the rows by
// exp(2 pi i f rho s_j / f_s): at the frames' common instants, where a motion of alias order 0 has one phase, the phase
// exp(2 pi i n rho s_j) is left, and the columns of a model of order 0 do not hold it. Two kinds:
//
// - A mode of the structure that folds. Strip by strip of the spectrum the alias order is estimated from the shear of
//   the regions' points, which is 2 pi n rho times the region's own displacement and a quarter of a period before or
//   after it; order and readout time are known, so that nothing is fitted but the order.
// - The tail of the camera's motion, whose spectrum falls off as a power law. It is noise of known shape: its power
// near
//   half the rate is that of the estimated motion, beyond it falls off with the third power of the frequency at least.
//   The residual is divided by its standard deviation there (generalised least squares): what it may hold weighs less.
class AliasedMotion {
 public:
  // Of one frame model: whitened columns (2 points x columns), of which the first n_regions move single regions; what
  // of the readout a point is seen at, and a column on average; orthonormal columns that the model removes.
  struct Columns {
    const Eigen::MatrixXd& x;
    Eigen::Index n_own, n_regions;
    const Eigen::VectorXd& share;
    const Eigen::VectorXd& column_share;
    const Eigen::MatrixXd& q;
  };
  AliasedMotion(const FrameShift& shift, const Columns& columns, double rate_hz, double readout_frames);

  // Part of the modes that fold in the points' series at the common instants, 2 points x frames in sigmas; empty: none.
  // amplitudes: of the columns, at the common instants; residual: what the model leaves of the points' series.
  [[nodiscard]] Eigen::MatrixXd folded(const Eigen::MatrixXd& amplitudes, const Eigen::MatrixXd& residual) const;

  // Learns the camera's tail from the columns' amplitudes, whose noise has these variances.
  void learn_tail(const Eigen::MatrixXd& amplitudes, const Eigen::VectorXd& noise, const Eigen::MatrixXd& residual);
  // Series at the common instants, weighted by what the tail leaves certain; in place.
  void weigh(Eigen::MatrixXd& series) const;

 private:
  [[nodiscard]] Eigen::VectorXd beside(Eigen::VectorXd field) const;  // the model's columns
  struct Strip {                                                      // of the spectrum
    Eigen::Index from, count;
    double b, c;
    int order;
  };
  [[nodiscard]] std::vector<Strip> strips(const Eigen::MatrixXd& amplitudes, const Eigen::MatrixXd& residual) const;
  void decide(std::vector<Strip>& strips) const;

  const FrameShift& shift_;
  Columns columns_;
  double rate_hz_, readout_frames_;
  Eigen::MatrixXd directions_;  // orthonormal
  Eigen::VectorXd power_;       // of the tail along them at half the rate, in noise variances
};

}  // namespace core::closure

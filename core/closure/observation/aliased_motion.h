#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/closure/observation/alias_orders.h"
#include "core/closure/observation/frame_shift.h"

namespace core::closure {

class PointMotionModel;

// Motion above half the frame rate. Motion at f = nu + n f_s appears at nu, but its phase varies over the rows as
// exp(2 pi i f rho s_j / f_s). At the frames' common instants, where motion of alias order 0 has one phase in all rows,
// the phase exp(2 pi i n rho s_j) remains, which the columns of a model of order 0 cannot represent. Two kinds:
//
// - A folded mode of the structure. For each strip of the spectrum the alias orders are estimated from the shear of the
//   regions' points, which is 2 pi n rho times the region's own displacement, a quarter of a period before or after it
//   (alias_orders.h). The readout time and the possible orders are known, so that only the order is estimated.
// - The tail of the camera's motion, whose spectrum decays as a power law. It is noise of known spectral shape:
//   its power near half the rate is that of the estimated motion; above, it decays at least with the third power of
//   the frequency. The residual in these directions is divided by its standard deviation (generalised least squares),
//   so that directions dominated by the tail have less weight.
class AliasedMotion {
 public:
  // Inputs from one model: its columns (2 points x columns, px), the first n_regions of which move single regions; the
  // mean readout fraction of each column's points.
  struct Columns {
    const PointMotionModel& model;
    const Eigen::MatrixXd& fields_px;
    Eigen::Index n_own, n_regions;
    const Eigen::VectorXd& share;
  };
  AliasedMotion(const FrameShift& shift, const Columns& columns, double rate_hz, double readout_frames);

  // Contribution of folded modes to the points' series at the common instants, 2 points x frames in sigmas; empty:
  // none. amplitudes: of the columns, at the common instants; residual: of the points' series after the fit.
  [[nodiscard]] Eigen::MatrixXd folded(const Eigen::MatrixXd& amplitudes, const Eigen::MatrixXd& residual) const;

  // Estimates the camera's tail from the amplitudes of the columns and their noise variances.
  void learn_tail(const Eigen::MatrixXd& amplitudes, const Eigen::VectorXd& noise, const Eigen::MatrixXd& residual);
  // Weights series at the common instants by the inverse standard deviation of the tail plus noise; in place.
  void weigh(Eigen::MatrixXd& series) const;
  // The same of fields of a motion at one frequency; of_half: apparent frequency over half the rate.
  void weigh_at(double of_half, Eigen::MatrixXcd& fields) const;

 private:
  // Change of the weight of each direction at an apparent frequency: -1 (no weight) .. 0.
  [[nodiscard]] Eigen::VectorXd change_at(double of_half) const;
  // Readout fraction of a point (row 2 j or 2 j + 1) after the mean of a column's.
  [[nodiscard]] double rows_later(Eigen::Index row, Eigen::Index column) const;
  // A field in px, whitened: its part outside the model's columns.
  [[nodiscard]] Eigen::VectorXd beside(const Eigen::VectorXd& field_px) const;
  [[nodiscard]] std::vector<AliasStrip> strips(const Eigen::MatrixXd& amplitudes,
                                               const Eigen::MatrixXd& residual) const;

  const FrameShift& shift_;
  Columns columns_;
  double rate_hz_, readout_frames_;
  Eigen::MatrixXd directions_;  // orthonormal
  Eigen::VectorXd power_;       // power of the tail along directions_ at half the rate, in noise variances
};

}  // namespace core::closure

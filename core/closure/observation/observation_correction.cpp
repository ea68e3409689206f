// Measured positions less what the adopted effects do to them.
#include <Eigen/LU>
#include <cmath>
#include <utility>

#include "core/closure/observation/observation_level.h"
#include "core/closure/observation/rotation_remainder.h"

namespace core::closure {

// Measured positions less the adopted constants' and lines' part.
Eigen::MatrixXd ObservationLevel::corrected(bool solved) {
  Eigen::MatrixXd positions = measured_, error = Eigen::MatrixXd::Zero(measured_.rows(), measured_.cols());
  const CorrectionView view{record_, predicted_px_};
  for (const Adopted& a : adopted_) {
    if (a.effect.form == ObservationEffect::Form::kLine && a.line_motion.size() > 0) positions -= a.line_motion;
  }
  for (const bool of_tracker : {true, false}) {
    for (const Adopted& a : adopted_) {
      if (a.effect.correct == nullptr || a.effect.of_tracker != of_tracker) continue;
      const Eigen::MatrixXd before = of_tracker ? positions : Eigen::MatrixXd{};
      a.effect.correct(a.values, view, positions);
      if (of_tracker) error += before - positions;
    }
  }
  tracker_error_px_ = std::move(error);
  if (solved) take_out_turns(positions);
  return positions;
}

// How much the adopted lens stretches the image at the points when it is taken out; noise is stretched alike.
Eigen::VectorXd ObservationLevel::magnification(const Eigen::VectorXd& places_px) const {
  constexpr double kApart_px = 1.0;
  const Eigen::Index n = places_px.size() / 2;
  Eigen::MatrixXd around(places_px.size(), 4);
  for (Eigen::Index j = 0; j < n; ++j) {
    around.middleRows(2 * j, 2).colwise() = places_px.segment<2>(2 * j);
    around.block<2, 2>(2 * j, 0) += kApart_px * Eigen::Matrix2d::Identity();
    around.block<2, 2>(2 * j, 2) -= kApart_px * Eigen::Matrix2d::Identity();
  }
  const CorrectionView view{record_, predicted_px_};
  for (const Adopted& a : adopted_) {
    if (a.effect.correct != nullptr && !a.effect.of_tracker) a.effect.correct(a.values, view, around);
  }
  Eigen::VectorXd out(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const Eigen::Matrix2d stretch = (around.block<2, 2>(2 * j, 0) - around.block<2, 2>(2 * j, 2)) / (2.0 * kApart_px);
    const double area = std::abs(stretch.determinant());
    out(j) = area > 0.1 && area < 10.0 ? std::sqrt(area) : 1.0;
  }
  return out;
}

Eigen::Index ObservationLevel::amplitude_row(std::size_t adopted) const {
  Eigen::Index full = model_.n_own(), low = full;
  for (const Adopted& other : adopted_) low += other.field.size() > 0 && !other.low_band ? 1 : 0;
  for (std::size_t i = 0; i < adopted; ++i) {
    if (adopted_[i].field.size() > 0) ++(adopted_[i].low_band ? low : full);
  }
  return adopted_[adopted].low_band ? low : full;
}

// The series are those of the solution before.
void ObservationLevel::take_out_turns(Eigen::MatrixXd& positions) const {
  Eigen::MatrixXd turns = Eigen::MatrixXd::Zero(3, positions.cols()), rates = turns;
  double share = 0.0;
  bool any = false;
  for (std::size_t i = 0; i < adopted_.size(); ++i) {
    if (adopted_[i].effect.turn.isZero() || amplitude_row(i) >= model_.amplitudes().rows()) continue;
    const Eigen::Index row = amplitude_row(i);
    turns += adopted_[i].effect.turn * model_.amplitudes().row(row);
    rates += adopted_[i].effect.turn * model_.rates().row(row);
    share = model_.share_of_column(row);
    any = true;
  }
  if (any) take_out_remainder(record_, model_.geometry(), turns, rates, readout_frames_, share, positions);
}

}  // namespace core::closure

#include "core/closure/observation/held_out.h"

#include <algorithm>

#include "core/closure/observation/time_filter.h"
#include "core/linear/dense.h"

namespace core::closure {
namespace {

constexpr Eigen::Index kParts = 5;

}  // namespace

ResidualMoments residual_moments(const Eigen::MatrixXd& residual, const Eigen::MatrixXd& cosines) {
  ResidualMoments m;
  const Eigen::Index n = residual.cols(), rows = residual.rows();
  m.all_sum = m.low_sum = Eigen::MatrixXd::Zero(rows, rows);
  const Eigen::MatrixXd low = low_amplitudes(residual, cosines);
  for (Eigen::Index b = 0; b < kParts; ++b) {
    const Eigen::Index from = b * n / kParts, to = (b + 1) * n / kParts;
    m.all.push_back(gram(residual.middleCols(from, to - from)));
    Eigen::MatrixXd part(rows, 0);
    const Eigen::Index count = (low.cols() - b + kParts - 1) / kParts;
    part.resize(rows, std::max<Eigen::Index>(count, 0));
    for (Eigen::Index c = 0; c < part.cols(); ++c) part.col(c) = low.col(b + c * kParts);
    m.low.emplace_back(gram(part));
    m.all_sum += m.all.back();
    m.low_sum += m.low.back();
  }
  return m;
}

Eigen::VectorXd leading_pattern(const Eigen::MatrixXd& moments) {
  Eigen::Index start = 0;
  moments.diagonal().maxCoeff(&start);
  Eigen::VectorXd v = moments.col(start);
  for (int step = 0; step < 60 && v.norm() > 0.0; ++step) v = (moments * v.normalized()).eval();
  return v.norm() > 0.0 ? v.normalized().eval() : v;
}

HeldOut::HeldOut(const PointMotionModel& model)
    : high_(model.q_high()),
      low_(model.q_low()),
      low_share_(static_cast<double>(model.cosines().cols()) / static_cast<double>(model.cosines().rows())),
      n_values_(static_cast<double>(high_.n_values()) * static_cast<double>(model.cosines().rows())) {}

double HeldOut::squares(const ResidualMoments& moments) const {
  return high_.squares(moments.all_sum - moments.low_sum) + low_.squares(moments.low_sum);
}

double HeldOut::noise_variance() const {
  return (1.0 - low_share_) * high_.noise_variance() + low_share_ * low_.noise_variance();
}

PatternGain HeldOut::of_pattern(const Eigen::VectorXd& beside_low, const Eigen::VectorXd& beside_high,
                                const ResidualMoments& moments, double upper_share) const {
  const Eigen::MatrixXd high = moments.all_sum - moments.low_sum;
  const double gain_low = low_.squares(moments.low_sum) - low_.squares_with(moments.low_sum, beside_low);
  const double gain_high = high_.squares(high) - high_.squares_with(high, beside_high);
  PatternGain out;
  out.low_band = gain_high < upper_share * n_values_;
  out.gain = out.low_band ? gain_low : gain_low + gain_high;
  return out;
}

double HeldOut::learned_gain(const std::vector<Eigen::MatrixXd>& parts, const Eigen::MatrixXd& sum,
                             const LeaveOnePointOut& with) {
  double gain = 0.0;
  for (const Eigen::MatrixXd& part : parts) {
    const Eigen::VectorXd g = leading_pattern(sum - part);
    gain += with.squares(part) - with.squares_with(part, g);
  }
  return gain;
}

PatternGain HeldOut::of_learned(const ResidualMoments& moments) const {
  const double full = learned_gain(moments.all, moments.all_sum, high_);
  const double low = learned_gain(moments.low, moments.low_sum, low_);
  return {std::max(low, full), low >= full};
}

}  // namespace core::closure

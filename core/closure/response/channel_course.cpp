#include "core/closure/response/channel_course.h"

#include <algorithm>
#include <cmath>

#include "core/closure/response/channel_retime.h"

namespace core::closure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kCourseParts = ChannelPredictor::kParts;
constexpr double kWide = 0.05, kNarrow = 0.012;  // half widths of the tested changes of frequency
constexpr double kMost = 0.25;

// Remainder of a course in a record on a warped time: inner products of the innovations with their derivative by the
// frequencies of the poles below 0.36 of the rate along the course (frequency_derivative), per part.
struct Left {
  VectorXd along = VectorXd::Zero(kCourseParts), size = VectorXd::Zero(kCourseParts);
  bool ok = false;
  [[nodiscard]] double coefficient(Index without) const {
    const double rest = size.sum() - (without < 0 ? 0.0 : size(without));
    return rest > 0.0 ? (along.sum() - (without < 0 ? 0.0 : along(without))) / rest : 0.0;
  }
};

Left left_at(double change, const ChannelRecord& record, Index order, const VectorXd& course) {
  Left out;
  const VectorXd time_s = time_of_factor((1.0 + change * course.array()).max(0.2), record.rate_hz);
  ChannelRecord own = record, scaled;
  own.value = course, own.input.resize(course.size(), 0);
  const ChannelRecord even = warped(record, time_s);
  const VectorXd even_course = warped(own, time_s).value.col(0);
  const ChannelPredictor predictor = fit_predictor(even, order, scaled);
  const MatrixXd derivative = predictor.ok ? frequency_derivative(predictor, record.rate_hz) : MatrixXd();
  if (derivative.size() == 0) return out;
  VectorXd history(order * predictor.n_channels);
  for (Index k = order; k < scaled.n_samples(); ++k) {
    if (predictor.plain[static_cast<std::size_t>(k)] == 0 || !std::isfinite(even_course(k))) continue;
    for (Index i = 0; i < order; ++i)
      history.segment(i * predictor.n_channels, predictor.n_channels) = scaled.value.row(k - 1 - i).transpose();
    const VectorXd g = predictor.whitener * (even_course(k) * (derivative * history));
    out.along(predictor.part_of(k)) += g.dot(predictor.whitener * predictor.innovation.row(k).transpose());
    out.size(predictor.part_of(k)) += g.squaredNorm();
  }
  out.ok = out.size.sum() > 0.0;
  return out;
}

// Zero crossing of the line through the coefficients; `fallback` if the line does not decrease.
double crossing(const std::vector<double>& change, const std::vector<Left>& left, Index without, double fallback) {
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  const auto n = static_cast<double>(change.size());
  for (std::size_t i = 0; i < change.size(); ++i) x += change[i] / n, y += left[i].coefficient(without) / n;
  for (std::size_t i = 0; i < change.size(); ++i) {
    xx += (change[i] - x) * (change[i] - x);
    xy += (change[i] - x) * (left[i].coefficient(without) - y);
  }
  return xy < 0.0 ? std::clamp(x - y * xx / xy, -kMost, kMost) : fallback;
}

}  // namespace

// Noise in the regressors biases the coefficient low, but not its zero: it vanishes where the course is removed.
CourseFit fit_course(const ChannelRecord& record, Index order, const VectorXd& course) {
  CourseFit out;
  for (const double step : {kWide, kNarrow, kNarrow}) {
    std::vector<double> tried;
    std::vector<Left> left;
    for (const double times : {-1.0, -0.5, 0.5, 1.0}) {
      tried.push_back(out.change + times * step);
      left.push_back(left_at(tried.back(), record, order, course));
      if (!left.back().ok) return {};
    }
    const double before = out.change;
    out.change = crossing(tried, left, -1, before);
    out.without.clear();
    for (Index part = 0; part < kCourseParts; ++part) out.without.push_back(crossing(tried, left, part, out.change));
  }
  return out;
}

}  // namespace core::closure

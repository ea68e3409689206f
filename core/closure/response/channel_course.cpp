#include "core/closure/response/channel_course.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/closure/response/channel_retime.h"

namespace core::closure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kParts = ChannelPredictor::kParts;
// Of the grid of changes, odd multiples only: a change of nothing would be the only one without interpolation, whose
// noise is not smoothed by it.
constexpr double kStep = 0.0025;
constexpr int kFirst[] = {-25, -13, -5, 5, 13, 25};
constexpr int kMost = 61, kAround = 8;  // steps to either side of the best

// Below a third of the rate: modes above it may be folded ones, whose apparent frequency falls while the true one rises.
MatrixXd low_passed(const MatrixXd& values) {
  constexpr Index kHalf = 12;
  constexpr double kCut = 0.33;  // of the rate
  VectorXd tap(2 * kHalf + 1);
  for (Index i = -kHalf; i <= kHalf; ++i) {
    const double x = 2.0 * kCut * static_cast<double>(i);
    const double sinc = i == 0 ? 1.0 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x);
    tap(i + kHalf) = 2.0 * kCut * sinc * (0.54 + 0.46 * std::cos(std::numbers::pi * static_cast<double>(i) / (kHalf + 1)));
  }
  MatrixXd out = MatrixXd::Zero(values.rows(), values.cols());
  for (Index i = -kHalf; i <= kHalf; ++i) {
    const Index first = std::max<Index>(0, -i), n = values.rows() - std::abs(i);
    if (n > 0) out.middleRows(first, n) += tap(i + kHalf) * values.middleRows(first + i, n);
  }
  return out;
}

// Squared innovations of each part of the retimed record, mean per sample, in the metric of the first call.
class Objective {
 public:
  Objective(const ChannelRecord& record, Index order, const VectorXd& course)
      : record_(record), order_(order), course_(course) {}

  // Empty: it cannot be predicted.
  const VectorXd& at(int step) {
    if (const auto found = known_.find(step); found != known_.end()) return found->second;
    const VectorXd factor = (1.0 + kStep * step * course_.array()).max(0.2);
    ChannelRecord scaled;
    const ChannelRecord even = warped(record_, time_of_factor(factor, record_.rate_hz));
    const ChannelPredictor predictor = fit_predictor(even, order_, scaled);
    VectorXd out;
    if (predictor.ok) {
      // To the channels' own units: their deviations differ a little from change to change.
      const MatrixXd own = predictor.innovation * predictor.deviation.asDiagonal();
      if (metric_.size() == 0) metric_ = predictor.whitener * predictor.deviation.cwiseInverse().asDiagonal();
      MatrixXd white = own * metric_.transpose();
      VectorXd n = VectorXd::Zero(kParts);
      for (Index k = 0; k < white.rows(); ++k) {
        if (predictor.plain[static_cast<std::size_t>(k)] == 0) {
          white.row(k).setZero();
        } else {
          n(predictor.part_of(k)) += 1.0;
        }
      }
      white = low_passed(white);
      out = VectorXd::Zero(kParts);
      for (Index k = 0; k < white.rows(); ++k) out(predictor.part_of(k)) += white.row(k).squaredNorm();
      out.array() /= n.array().max(1.0);
    }
    return known_.emplace(step, std::move(out)).first->second;
  }

 private:
  const ChannelRecord& record_;
  Index order_;
  const VectorXd& course_;
  MatrixXd metric_;
  std::map<int, VectorXd> known_;
};

// The lowest point of the parabola through the values; the lowest value where it has none among them.
double lowest(const std::vector<double>& change, const VectorXd& value) {
  const auto n = static_cast<Index>(change.size());
  MatrixXd powers(n, 3);
  for (Index i = 0; i < n; ++i) {
    const double x = change[static_cast<std::size_t>(i)] - change.front();
    powers.row(i) << 1.0, x, x * x;
  }
  const VectorXd fit = powers.colPivHouseholderQr().solve(value);
  Index best = 0;
  value.minCoeff(&best);
  if (!(fit(2) > 0.0)) return change[static_cast<std::size_t>(best)];
  const double reach = change.back() - change.front();
  return change.front() + std::clamp(-0.5 * fit(1) / fit(2), -0.5 * reach, 1.5 * reach);
}

}  // namespace

CourseFit fit_course(const ChannelRecord& record, Index order, const VectorXd& course) {
  Objective objective(record, order, course);
  int best = kFirst[2];
  for (const int step : kFirst) {
    if (objective.at(step).size() == 0) return {};
    if (objective.at(step).sum() < objective.at(best).sum()) best = step;
  }
  // Downhill on the grid to the lowest place, then a parabola about it.
  for (int stride = 8; stride >= 2; stride /= 2) {
    for (bool moved = true; moved;) {
      moved = false;
      for (const int next : {best - stride, best + stride}) {
        if (std::abs(next) > kMost || objective.at(next).size() == 0) continue;
        if (objective.at(next).sum() < objective.at(best).sum()) best = next, moved = true;
      }
    }
  }
  std::vector<double> change;
  std::vector<VectorXd> values;
  for (int step = best - kAround; step <= best + kAround; step += 4) {
    if (objective.at(step).size() == 0) continue;
    change.push_back(kStep * step);
    values.push_back(objective.at(step));
  }
  CourseFit out;
  VectorXd sum(static_cast<Index>(values.size()));
  for (Index part = -1; part < kParts; ++part) {
    for (Index i = 0; i < sum.size(); ++i) {
      const VectorXd& of_parts = values[static_cast<std::size_t>(i)];
      sum(i) = of_parts.sum() - (part >= 0 ? of_parts(part) : 0.0);
    }
    const double found = values.size() < 3 ? kStep * best : lowest(change, sum);
    if (part < 0) {
      out.change = found;
    } else {
      out.without.push_back(found);
    }
  }
  return out;
}

}  // namespace core::closure

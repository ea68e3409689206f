#include "core/closure/observation/track_noise.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace core::closure {
namespace {

using Index = Eigen::Index;

constexpr double kLongest_s = 10.0;  // longest correlation time that is followed
constexpr int kLongestPeriod_frames = 300;
constexpr int kLeastPeriods = 8;
constexpr double kSignificant = 6.0;  // standard deviations

double correlation_time(const Eigen::MatrixXd& residual, double rate_hz) {
  const double squares = residual.squaredNorm();
  const auto longest = std::min(residual.cols() / 4, static_cast<Index>(kLongest_s * rate_hz));
  double before = 1.0;
  for (Index lag = 1; lag <= longest && squares > 0.0; ++lag) {
    const Index n = residual.cols() - lag;
    const double now = residual.leftCols(n).cwiseProduct(residual.rightCols(n)).sum() / squares;
    if (now < 1.0 / std::numbers::e) {
      if (lag == 1) return 0.0;
      const double share = (before - 1.0 / std::numbers::e) / (before - now);
      return (static_cast<double>(lag - 1) + share) / rate_hz;
    }
    before = now;
  }
  return static_cast<double>(longest) / rate_hz;
}

// Logarithm of the mean square change from frame to frame; NaN beside a gap.
std::vector<double> log_changes(const Eigen::MatrixXd& residual) {
  std::vector<double> out;
  for (Index k = 1; k < residual.cols(); ++k) {
    const bool seen = residual.col(k - 1).squaredNorm() > 0.0 && residual.col(k).squaredNorm() > 0.0;
    out.push_back(seen ? std::log((residual.col(k) - residual.col(k - 1)).squaredNorm()) : std::nan(""));
  }
  return out;
}

struct Moments {
  double n = 0.0, sum = 0.0, squares = 0.0;
  void add(double x) noexcept { n += 1.0, sum += x, squares += x * x; }
  [[nodiscard]] double mean() const noexcept { return sum / n; }
};

}  // namespace

TrackNoise track_noise(const Eigen::MatrixXd& residual, double rate_hz) {
  TrackNoise out;
  out.correlation_s = correlation_time(residual, rate_hz);
  const std::vector<double> changes = log_changes(residual);
  Moments all;
  for (const double x : changes) {
    if (std::isfinite(x)) all.add(x);
  }
  const int longest = std::min(kLongestPeriod_frames, static_cast<int>(changes.size()) / kLeastPeriods);
  double most = kSignificant;
  for (int period = 2; period <= longest; ++period) {
    std::vector<Moments> of_phase(static_cast<std::size_t>(period));
    for (std::size_t k = 0; k < changes.size(); ++k) {
      if (std::isfinite(changes[k])) of_phase[k % static_cast<std::size_t>(period)].add(changes[k]);
    }
    for (const Moments& own : of_phase) {
      if (own.n < kLeastPeriods - 1) continue;
      const Moments rest{all.n - own.n, all.sum - own.sum, all.squares - own.squares};
      const double spread = std::sqrt(std::max(rest.squares / rest.n - rest.mean() * rest.mean(), 1e-12));
      const double significance = (own.mean() - rest.mean()) / (spread * std::sqrt(1.0 / own.n + 1.0 / rest.n));
      if (!(significance > most)) continue;
      most = significance;
      out.period_frames = period, out.period_change = std::exp(0.5 * (own.mean() - rest.mean()));
    }
  }
  return out;
}

}  // namespace core::closure

#include "core/spectrum/bridge_losses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace core {

namespace {

constexpr std::size_t kReach =
    32;                          // samples on either side used for a prediction: fewer do not separate modes from noise
constexpr int kRounds = 4;       // iterations of autocorrelation and prediction
constexpr double kRidge = 1e-7;  // share of the variance on the diagonal: a pure sine stays solvable

using Autocorrelation = std::array<double, 2 * kReach + 1>;

// The nearest observed samples on both sides of `at`, excluding `at` itself; false if they are too far apart.
struct Neighbours {
  std::size_t before = 0, after = 0;

  bool find(std::span<const std::uint8_t> seen, std::size_t at) noexcept {
    constexpr std::size_t kFarthest = kLongestBridge + 1;
    const std::size_t lowest = at >= kFarthest ? at - kFarthest : 0,
                      highest = std::min(seen.size() - 1, at + kFarthest);
    for (before = at; before > lowest && (before == at || seen[before] == 0);) --before;
    for (after = at; after < highest && (after == at || seen[after] == 0);) ++after;
    // Excluding the sample itself makes a gap one sample longer.
    return before < at && after > at && seen[before] != 0 && seen[after] != 0 && after - before <= kFarthest;
  }
  [[nodiscard]] double line(std::span<const double> x, std::size_t at) const noexcept {
    const double share = static_cast<double>(at - before) / static_cast<double>(after - before);
    return (1.0 - share) * x[before] + share * x[after];
  }
};

// Autocorrelation under a Hann window, whose own autocorrelation decreases with the square of the lag, so that slow
// motion stays highly correlated. Computed from an actual record, hence positive semidefinite.
Autocorrelation autocorrelation(std::span<const double> x, double mean) noexcept {
  Autocorrelation out{};
  std::array<double, 2 * kReach + 1> last{};  // of the windowed record, newest first
  const double step = 2.0 * std::numbers::pi / static_cast<double>(x.size());
  for (std::size_t t = 0; t < x.size(); ++t) {
    std::rotate(last.rbegin(), last.rbegin() + 1, last.rend());
    last[0] = (0.5 - 0.5 * std::cos(step * (static_cast<double>(t) + 0.5))) * (x[t] - mean);
    for (std::size_t lag = 0; lag < out.size(); ++lag) out[lag] += last[0] * last[lag];
  }
  return out;
}

// Best linear prediction of a sample from the observed samples around it.
class Predictor {
 public:
  Predictor(std::span<const double> x, std::span<const std::uint8_t> seen, const Autocorrelation& r) noexcept
      : x_(x), seen_(seen), r_(r) {}

  // Requires an observed sample on both sides. Returns `line` if the equations have no solution.
  [[nodiscard]] double at(std::size_t t, double line) noexcept {
    gather(t);
    if (!factorise()) return line;
    solve_all();
    return predict(line);
  }

 private:
  static constexpr std::size_t kMost = 2 * kReach, kSides = 3;  // right-hand sides: covariance with x_t, 1, distance

  void gather(std::size_t t) noexcept {
    n_ = 0;
    for (std::size_t j = t > kReach ? t - kReach : 0; j <= std::min(x_.size() - 1, t + kReach); ++j) {
      if (j == t || seen_[j] == 0) continue;
      value_[n_] = x_[j];
      distance_[n_] = static_cast<double>(j) - static_cast<double>(t);
      side_[0][n_] = r_[j > t ? j - t : t - j];
      side_[1][n_] = 1.0;
      side_[2][n_] = distance_[n_];
      position_[n_++] = j;
    }
  }
  // Cholesky factor of the covariance of the observed samples.
  [[nodiscard]] bool factorise() noexcept {
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t k = 0; k <= i; ++k) {
        double sum = r_[position_[i] - position_[k]] + (i == k ? kRidge * r_[0] : 0.0);
        for (std::size_t m = 0; m < k; ++m) sum -= factor_[i][m] * factor_[k][m];
        if (i == k && !(sum > 0.0)) return false;
        factor_[i][k] = i == k ? std::sqrt(sum) : sum / factor_[k][k];
      }
    }
    return n_ > 0;
  }
  // Forward substitution: L^-1 b; the scalar product of two results is b^T R^-1 c.
  void solve_all() noexcept {
    for (std::array<double, kMost>& b : side_) forward(b);
    forward(value_);
  }
  void forward(std::array<double, kMost>& b) const noexcept {
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t m = 0; m < i; ++m) b[i] -= factor_[i][m] * b[m];
      b[i] /= factor_[i][i];
    }
  }
  [[nodiscard]] double product(const std::array<double, kMost>& a, const std::array<double, kMost>& b) const noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < n_; ++i) sum += a[i] * b[i];
    return sum;
  }
  // Estimates the trend a + b (j - t) by generalised least squares, with value a at t, and the rest from its
  // covariance.
  [[nodiscard]] double predict(double line) const noexcept {
    const double oo = product(side_[1], side_[1]), od = product(side_[1], side_[2]), dd = product(side_[2], side_[2]);
    const double ov = product(side_[1], value_), dv = product(side_[2], value_);
    const double determinant = oo * dd - od * od;
    if (!(determinant > 1e-12 * oo * dd)) return line;
    const double a = (dd * ov - od * dv) / determinant, b = (oo * dv - od * ov) / determinant;
    return a + product(side_[0], value_) - a * product(side_[0], side_[1]) - b * product(side_[0], side_[2]);
  }

  std::span<const double> x_;
  std::span<const std::uint8_t> seen_;
  const Autocorrelation& r_;
  std::size_t n_ = 0;
  std::array<std::size_t, kMost> position_{};
  std::array<double, kMost> value_{}, distance_{};
  std::array<std::array<double, kMost>, kSides> side_{};
  std::array<std::array<double, kMost>, kMost> factor_{};
};

double mean_of(std::span<const double> y, std::span<const std::uint8_t> held) noexcept {
  double sum = 0.0, n = 0.0;
  for (std::size_t t = 0; t < y.size(); ++t) {
    if (held[t] != 0) sum += y[t], n += 1.0;
  }
  return n > 0.0 ? sum / n : 0.0;
}

// Lost samples in y are already filled in.
Autocorrelation autocorrelation_of(std::span<double> y, std::span<const std::uint8_t> held) noexcept {
  const double mean = mean_of(y, held);
  for (std::size_t t = 0; t < y.size(); ++t) y[t] = held[t] != 0 ? y[t] : mean;
  return autocorrelation(y, mean);
}

}  // namespace

void bridge_losses(std::span<const double> x, std::span<const std::uint8_t> seen, std::span<double> y,
                   std::span<std::uint8_t> held) noexcept {
  std::copy(x.begin(), x.end(), y.begin());
  std::copy(seen.begin(), seen.end(), held.begin());
  if (std::all_of(seen.begin(), seen.end(), [](std::uint8_t s) { return s != 0; })) return;
  Neighbours neighbours;
  std::size_t n_lost = 0, n_kept = 0;
  for (std::size_t t = 0; t < x.size(); ++t) {
    if (!neighbours.find(seen, t)) continue;
    ++(seen[t] != 0 ? n_kept : n_lost);
    if (seen[t] == 0) y[t] = neighbours.line(x, t), held[t] = 1;
  }
  if (n_lost == 0 || n_kept == 0) return;
  Autocorrelation r = autocorrelation_of(y, held);
  for (int round = 1; round < kRounds; ++round) {
    Predictor predictor(x, seen, r);
    for (std::size_t t = 0; t < x.size(); ++t) {
      if (seen[t] == 0 && neighbours.find(seen, t)) y[t] = predictor.at(t, neighbours.line(x, t));
    }
    r = autocorrelation_of(y, held);
  }
  const double gain = static_cast<double>(n_lost + n_kept) / static_cast<double>(n_kept);  // 1 / (1 - p)
  Predictor predictor(x, seen, r);
  for (std::size_t t = 0; t < x.size(); ++t) {
    y[t] = x[t];
    if (!neighbours.find(seen, t)) continue;
    const double s = predictor.at(t, neighbours.line(x, t));
    y[t] = seen[t] != 0 ? s + gain * (x[t] - s) : s;
  }
}

}  // namespace core

#include "core/closure/observation/time_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/linear/dense.h"

namespace core::closure {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kKaiserBeta = 7.0;

// Modified Bessel function of order 0, by its series.
double bessel0(double x) {
  double sum = 1.0, term = 1.0;
  for (int k = 1; k < 40; ++k) {
    term *= (0.5 * x / k) * (0.5 * x / k);
    sum += term;
  }
  return sum;
}

double window(int n, int half) {
  const double place = static_cast<double>(n) / (half + 1);
  return bessel0(kKaiserBeta * std::sqrt(1.0 - place * place)) / bessel0(kKaiserBeta);
}

// Sample of a row beyond its ends.
double sample(const Eigen::MatrixXd& series, Eigen::Index row, Eigen::Index k) {
  const Eigen::Index last = series.cols() - 1;
  if (k < 0) return 2.0 * series(row, 0) - series(row, std::min(-k, last));
  if (k > last) return 2.0 * series(row, last) - series(row, std::max<Eigen::Index>(2 * last - k, 0));
  return series(row, k);
}

Eigen::MatrixXd filter(const Eigen::MatrixXd& series, const std::vector<double>& taps, double sign) {
  Eigen::MatrixXd out(series.rows(), series.cols());
  const auto half = static_cast<Eigen::Index>(taps.size()) - 1;
  std::vector<double> padded(static_cast<std::size_t>(series.cols() + 2 * half));
  for (Eigen::Index row = 0; row < series.rows(); ++row) {
    for (std::size_t i = 0; i < padded.size(); ++i)
      padded[i] = sample(series, row, static_cast<Eigen::Index>(i) - half);
    for (Eigen::Index k = 0; k < series.cols(); ++k) {
      const double* at = padded.data() + k + half;
      double sum = taps[0] * *at;
      for (Eigen::Index n = 1; n <= half; ++n) sum += taps[static_cast<std::size_t>(n)] * (at[-n] + sign * at[n]);
      out(row, k) = sum;
    }
  }
  return out;
}

}  // namespace

std::vector<double> smoother_taps(double cutoff, int half) {
  std::vector<double> taps{2.0 * cutoff};
  for (int n = 1; n <= half; ++n) taps.push_back(std::sin(2.0 * kPi * cutoff * n) / (kPi * n) * window(n, half));
  double sum = taps[0];
  for (std::size_t n = 1; n < taps.size(); ++n) sum += 2.0 * taps[n];
  for (double& tap : taps) tap /= sum;
  return taps;
}

std::vector<double> derivative_taps(double cutoff, int half) {
  std::vector<double> taps{0.0};
  for (int n = 1; n <= half; ++n) {
    const double angle = 2.0 * kPi * cutoff * n;
    const double ideal = 2.0 * cutoff * std::cos(angle) / n - std::sin(angle) / (kPi * n * n);
    taps.push_back(ideal * window(n, half));
  }
  return taps;
}

Eigen::MatrixXd filter_even(const Eigen::MatrixXd& series, const std::vector<double>& taps) {
  return filter(series, taps, 1.0);
}

Eigen::MatrixXd filter_odd(const Eigen::MatrixXd& series, const std::vector<double>& taps) {
  return filter(series, taps, -1.0);
}

Eigen::MatrixXd low_cosines(Eigen::Index n_frames, double rate_hz, double limit_hz) {
  const auto n = static_cast<double>(n_frames);
  const auto count = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(2.0 * limit_hz * n / rate_hz) + 1, 1, n_frames);
  Eigen::MatrixXd cosines(n_frames, count);
  for (Eigen::Index m = 0; m < count; ++m) {
    const double scale = std::sqrt((m == 0 ? 1.0 : 2.0) / n);
    for (Eigen::Index k = 0; k < n_frames; ++k)
      cosines(k, m) = scale * std::cos(kPi * static_cast<double>(m) * (static_cast<double>(k) + 0.5) / n);
  }
  return cosines;
}

Eigen::MatrixXd low_amplitudes(const Eigen::MatrixXd& values, const Eigen::MatrixXd& cosines) {
  const Eigen::Index n = values.cols(), half = n / 2, count = cosines.cols();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(values.rows(), count);
  const Eigen::MatrixXd first = values.leftCols(half), last = values.rightCols(half).rowwise().reverse();
  for (const Eigen::Index odd : {0, 1}) {
    const Eigen::Index n_part = (count + 1 - odd) / 2;
    if (n_part == 0) continue;
    Eigen::MatrixXd part(half, n_part), sum = Eigen::MatrixXd::Zero(values.rows(), n_part);
    for (Eigen::Index c = 0; c < n_part; ++c) part.col(c) = cosines.col(2 * c + odd).head(half);
    add_product(sum, 1.0, odd == 0 ? (first + last).eval() : (first - last).eval(), part);
    for (Eigen::Index c = 0; c < n_part; ++c) out.col(2 * c + odd) = sum.col(c);
  }
  if (n % 2 == 1) out += values.col(half) * cosines.row(half);
  return out;
}

}  // namespace core::closure

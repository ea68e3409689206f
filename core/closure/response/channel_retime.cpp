#include "core/closure/response/channel_retime.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/types/constants.h"

namespace core::closure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kWidestStep = 1.75;  // in steps of the grid: larger distances are gaps

// Lagrange polynomial through the four uneven nodes around `at`; next to a gap or end a line through two.
double through(const VectorXd& time_s, const Eigen::Ref<const VectorXd>& value, Index below, double at) {
  const auto lagrange = [&](Index first, Index last) {
    double sum = 0.0;
    for (Index i = first; i <= last; ++i) {
      double weight = 1.0;
      for (Index j = first; j <= last; ++j) {
        if (j != i) weight *= (at - time_s(j)) / (time_s(i) - time_s(j));
      }
      sum += weight * value(i);
    }
    return sum;
  };
  const auto apart = [&](Index k) { return time_s(k + 1) - time_s(k); };
  const bool is_among = below > 0 && below + 2 < time_s.size();
  if (is_among && std::max(apart(below - 1), apart(below + 1)) < 3.0 * apart(below)) {
    if (const double cubic = lagrange(below - 1, below + 2); std::isfinite(cubic)) return cubic;
  }
  return lagrange(below, below + 1);
}

}  // namespace

namespace {

// Values of a column at an instant between samples `below` and `below + 1`.
using Interpolate = double (*)(const VectorXd& time_s, const Eigen::Ref<const VectorXd>& value, Index below, double at);

ChannelRecord on_even_grid(const ChannelRecord& record, const VectorXd& time_s, Interpolate interpolate) {
  ChannelRecord out = record;
  const Index n_old = record.n_samples();
  if (n_old < 2) return out;
  const Index n = static_cast<Index>(std::floor((time_s(n_old - 1) - time_s(0)) * record.rate_hz + 1e-9)) + 1;
  out.value.setConstant(n, record.value.cols(), kNan);
  out.input.setConstant(n, record.input.cols(), kNan);
  Index below = 0;
  for (Index k = 0; k < n; ++k) {
    const double at = time_s(0) + static_cast<double>(k) / record.rate_hz;
    while (below + 2 < n_old && time_s(below + 1) <= at) ++below;
    if (time_s(below + 1) - time_s(below) > kWidestStep / record.rate_hz) continue;
    for (Index c = 0; c < out.value.cols(); ++c) out.value(k, c) = interpolate(time_s, record.value.col(c), below, at);
    for (Index c = 0; c < out.input.cols(); ++c) out.input(k, c) = interpolate(time_s, record.input.col(c), below, at);
  }
  return out;
}

// Kaiser window of beta 6 over shares of its half-width, 0 .. 1, from a table.
double kaiser(double share) {
  constexpr std::size_t kSteps = 2048;
  static const std::array<double, kSteps + 2> kTable = [] {
    constexpr double kBeta = 6.0;
    std::array<double, kSteps + 2> out{};
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double s = static_cast<double>(i) / kSteps;
      out[i] = std::cyl_bessel_i(0.0, kBeta * std::sqrt(std::max(0.0, 1.0 - s * s))) / std::cyl_bessel_i(0.0, kBeta);
    }
    return out;
  }();
  const double at = std::min(std::abs(share), 1.0) * kSteps;
  const auto below = static_cast<std::size_t>(at);
  return kTable[below] + (at - static_cast<double>(below)) * (kTable[below + 1] - kTable[below]);
}

// For evenly spaced samples: a sinc under that window.
double by_sinc(const VectorXd& time_s, const Eigen::Ref<const VectorXd>& value, Index below, double at) {
  constexpr Index kHalf = 16;
  const double x = (at - time_s(below)) / (time_s(below + 1) - time_s(below));
  if (below + 1 < kHalf || below + kHalf >= value.size()) return through(time_s, value, below, at);
  if (x < 1e-9) return value(below);
  double sum = 0.0;
  const double sine = std::sin(std::numbers::pi * x) / std::numbers::pi;
  for (Index i = 1 - kHalf; i <= kHalf; ++i) {
    const double off = x - static_cast<double>(i);
    sum += (i % 2 == 0 ? 1.0 : -1.0) * sine / off * kaiser(off / static_cast<double>(kHalf)) * value(below + i);
  }
  if (!std::isfinite(sum)) return through(time_s, value, below, at);
  return sum;
}

}  // namespace

ChannelRecord retimed(const ChannelRecord& record, const VectorXd& time_s) {
  return on_even_grid(record, time_s, through);
}

ChannelRecord warped(const ChannelRecord& record, const VectorXd& time_s) {
  return on_even_grid(record, time_s, by_sinc);
}

VectorXd time_of_factor(const VectorXd& factor, double rate_hz) {
  VectorXd out(factor.size());
  double now = 0.0;
  for (Index k = 0; k < factor.size(); ++k) {
    out(k) = now;
    const double next = k + 1 < factor.size() ? factor(k + 1) : factor(k);
    now += std::max(0.5 * (factor(k) + next), 0.1) / rate_hz;
  }
  return out;
}

}  // namespace core::closure

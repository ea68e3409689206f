#include "core/tracking/outlier_rejection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace core {

namespace {

double squared_distance(const Vector2& a, const Vector2& b) noexcept {
  return (a.u - b.u) * (a.u - b.u) + (a.v - b.v) * (a.v - b.v);
}

// Log-likelihood of all valid points under one hypothesis, with the inlier share that maximises it.
double log_likelihood(std::span<const Vector2> motion, std::span<const std::uint8_t> valid, const Vector2& centre,
                      const MlesacConfig& config) noexcept {
  const double inverse_2s2 = 0.5 / (config.sigma_px * config.sigma_px);
  const double peak = inverse_2s2 / std::numbers::pi;
  const double outlier = 1.0 / (config.spread_px * config.spread_px);
  // The exponentials take most of the time and do not depend on the share, so they are kept.
  constexpr std::size_t kKept = 128;
  std::array<double, kKept> kept;
  const auto closeness = [&](std::size_t i) { return std::exp(-squared_distance(motion[i], centre) * inverse_2s2); };
  for (std::size_t i = 0; i < std::min(kKept, motion.size()); ++i) kept[i] = valid[i] != 0 ? closeness(i) : 0.0;
  double share = 0.5;
  double sum = 0.0;
  for (int iteration = 0; iteration < config.mixing_iterations; ++iteration) {
    const bool last = iteration + 1 == config.mixing_iterations;
    double inlier_weight = 0.0;
    double n = 0.0;
    for (std::size_t i = 0; i < motion.size(); ++i) {
      if (valid[i] == 0) continue;
      const double in = share * peak * (i < kKept ? kept[i] : closeness(i));
      const double total = in + (1.0 - share) * outlier;
      inlier_weight += in / total;
      if (last) sum += std::log(total);
      n += 1.0;
    }
    share = std::min(0.99, std::max(0.01, inlier_weight / n));
  }
  return sum;
}

// The hypothesis of highest likelihood: the motion of one of the points.
Vector2 likeliest(std::span<const Vector2> motion, std::span<const std::uint8_t> valid,
                  const MlesacConfig& config) noexcept {
  double best = -std::numeric_limits<double>::infinity();
  Vector2 centre;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    if (valid[i] == 0) continue;
    const double likelihood = log_likelihood(motion, valid, motion[i], config);
    if (likelihood > best) {
      best = likelihood;
      centre = motion[i];
    }
  }
  return centre;
}

// If all points lie within the gate of each other, they are inliers of any of them and of their mean.
bool all_agree(std::span<const Vector2> motion, std::span<const std::uint8_t> valid, double gate,
               Vector2& any) noexcept {
  Vector2 low{HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL};
  for (std::size_t i = 0; i < motion.size(); ++i) {
    if (valid[i] == 0) continue;
    any = motion[i];
    low = {std::min(low.u, any.u), std::min(low.v, any.v)};
    high = {std::max(high.u, any.u), std::max(high.v, any.v)};
  }
  return squared_distance(low, high) < gate;
}

}  // namespace

MlesacResult mlesac_translation(std::span<const Vector2> motion, std::span<const std::uint8_t> valid,
                                const MlesacConfig& config, std::span<std::uint8_t> inlier) noexcept {
  MlesacResult result;
  // The winner is itself a noisy point: the others are compared with the mean of its inliers, twice.
  constexpr double kGateSigmas = 3.5;
  const double gate = kGateSigmas * kGateSigmas * config.sigma_px * config.sigma_px * 2.0;
  Vector2 centre;
  if (!all_agree(motion, valid, gate, centre)) centre = likeliest(motion, valid, config);
  for (int pass = 0; pass < 2; ++pass) {
    Vector2 sum;
    result.n_inliers = 0;
    for (std::size_t i = 0; i < motion.size(); ++i) {
      inlier[i] = valid[i] != 0 && squared_distance(motion[i], centre) < gate ? 1 : 0;
      if (inlier[i] == 0) continue;
      sum.u += motion[i].u;
      sum.v += motion[i].v;
      ++result.n_inliers;
    }
    if (result.n_inliers > 0) centre = {sum.u / result.n_inliers, sum.v / result.n_inliers};
  }
  result.motion = centre;
  return result;
}

}  // namespace core

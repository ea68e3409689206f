#pragma once

#include <cstdint>
#include <span>

#include "core/types/vector2.h"

namespace core {

struct MlesacConfig {
  double sigma_px = 0.3;      // of an inlier's deviation from the common motion, per axis
  double spread_px = 50.0;    // side of the square over which outliers are uniformly distributed
  int mixing_iterations = 3;  // EM steps for the share of inliers
};

struct MlesacResult {
  Vector2 motion;  // mean motion of the inliers
  int n_inliers = 0;
};

// MLESAC (Torr & Zisserman 2000) for points that move by one common translation: selects the hypothesis that maximises
// the likelihood of a Gaussian-plus-uniform mixture. One point determines a hypothesis, so all points are tried: there
// are no random draws, and equal points give equal results. Sets inlier[i] of valid points (0 for invalid ones).
// O(n^2); does not allocate. Returns n_inliers = 0 if no point is valid.
[[nodiscard]] MlesacResult mlesac_translation(std::span<const Vector2> motion, std::span<const std::uint8_t> valid,
                                              const MlesacConfig& config, std::span<std::uint8_t> inlier) noexcept;

}  // namespace core

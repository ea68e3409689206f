#pragma once

#include <cstdint>
#include <span>

#include "core/types/vector2.h"

namespace core {

struct MlesacConfig {
  double sigma_px = 0.3;      // of an inlier about the common motion, per axis
  double spread_px = 50.0;    // side of the square in which outliers lie evenly
  int mixing_iterations = 3;  // EM steps for the share of inliers
};

struct MlesacResult {
  Vector2 motion;  // mean of the inliers
  int n_inliers = 0;
};

// MLESAC (Torr & Zisserman 2000) for points that move by one common translation: the hypothesis that maximises the
// likelihood of a Gaussian-and-uniform mixture wins. One point makes a hypothesis, so all of them are tried: no random
// draws, the same points always give the same answer. inlier[i] is set for valid points (0 for invalid ones).
// O(n^2); no allocation. Returns n_inliers = 0 when no point is valid.
[[nodiscard]] MlesacResult mlesac_translation(std::span<const Vector2> motion, std::span<const std::uint8_t> valid,
                                              const MlesacConfig& config, std::span<std::uint8_t> inlier) noexcept;

}  // namespace core

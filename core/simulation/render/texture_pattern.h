#pragma once

#include <cstdint>
#include <functional>

namespace core::simulation {

// What a texture shows beside its noise. The texture is the cubic B-spline whose coefficients follow it: closed form,
// as without.
struct PatternPoint {
  double grey = 0.0;   // above the texture's mean
  double noise = 1.0;  // share of contrast_rms
};
using TexturePattern = std::function<PatternPoint(double x_mm, double y_mm)>;  // from the plate's centre, y down

// One storey of a building: a wall with windows, whose glass and blinds differ, and the edge of the slab below.
[[nodiscard]] TexturePattern facade_pattern(double width_mm, double height_mm, std::uint64_t seed,
                                            std::uint64_t storey);
// What lies behind: sky, a town on the horizon, ground with a road. half_view_mm: from the middle of the image to its
// upper edge, in the background's plane.
[[nodiscard]] TexturePattern landscape_pattern(double half_view_mm, std::uint64_t seed);

}  // namespace core::simulation

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/types/vector2.h"

namespace core {

// Magnification of the image relative to the keyframe, b = |p_i1 - p_i2| / |p_01 - p_02|; the paper's scale is S_i =
// S_0 / b (Eq. 6). Structural motion is not magnification, so only distances are used in which it cancels.
class ScaleFactor {
 public:
  struct Point {
    Vector2 keyframe;  // undistorted px
    std::uint16_t region = 0;
    double axis_u = 1.0, axis_v = 0.0;  // unit axis of the region's motion
    bool both_axes = false;             // motion in any direction is possible
    bool counts = true;                 // false: excluded, because it is at another distance (background)
  };

  explicit ScaleFactor(std::vector<Point> points);

  // Method of the paper: the two keyframe points farthest apart; if one of them is lost, the next pair of a fixed list.
  // Keeps its last value if no listed pair is seen.
  [[nodiscard]] double two_point(std::span<const Vector2> position, std::span<const std::uint8_t> usable) noexcept;

  // Robust initial value: median over fixed pairs within regions and across the axes of motion.
  [[nodiscard]] double median_of_pairs(std::span<const Vector2> position,
                                       std::span<const std::uint8_t> usable) noexcept;

  // Least squares over all usable points: inside a region distances from its centre, across regions only the component
  // perpendicular to their axes of motion. Keeps its last value if no point is seen.
  [[nodiscard]] double least_squares(std::span<const Vector2> position, std::span<const std::uint8_t> usable) noexcept;

 private:
  struct Pair {
    std::size_t i, j;
    Vector2 direction;   // unit vector along which the distance is measured
    double distance_px;  // of the keyframe
  };

  void list_farthest_pairs();
  void list_motion_free_pairs();
  [[nodiscard]] bool magnification(const Pair& pair, std::span<const Vector2> position,
                                   std::span<const std::uint8_t> usable, double& b) const noexcept;

  std::vector<Point> points_;
  std::vector<Pair> farthest_;
  std::vector<Pair> motion_free_;
  std::vector<double> ratios_;  // work space
  std::size_t n_regions_ = 0;
  std::vector<Vector2> centre_now_, centre_keyframe_;  // per region, work space
  std::vector<double> count_;
  double last_ = 1.0;
};

}  // namespace core

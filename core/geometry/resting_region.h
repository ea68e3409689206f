#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "core/types/vector2.h"

namespace core {

// Points of one static region: undistorted px from the principal point, present and in the keyframe; whether each is
// seen at present; its place along the readout (ReadoutModel::fraction). turned: where the rotation that is removed
// from `position` puts the keyframe's point; the keyframe itself where none is.
struct RestingPoints {
  std::span<const Vector2> position, keyframe, turned;
  std::span<const std::uint8_t> seen;
  std::span<const double> readout_share;
};

// Motion of each point since the keyframe without the region's own zoom and rotation in the image plane, both about its
// keyframe centre (least squares over the inliers). A static region at another distance than the structure has another
// zoom, and its points share one motion only after its removal. Inliers are found by mlesac_translation(), with
// sigma_px. The motion of unseen points is undefined. Returns the rotation, rad, from u towards v. Does not allocate.
//
// A camera that moves while the rows are read shears the region, which half looks like a rotation and half like a zoom.
// Both are estimated from what the points' places along the readout do not explain: of rows, from the places along the
// row. A region that extends along the readout alone keeps the whole of its places.
double follow_resting_region(const RestingPoints& points, double sigma_px, std::span<Vector2> motion,
                             std::span<std::uint8_t> inlier) noexcept;

// What the inliers show of the camera's small further rotations about x, y and z (columns): their mean motion over the
// focal lengths fx, fy, px, and the rotation above. Yaw and pitch turn a region beside the image's centre, too.
[[nodiscard]] Eigen::Matrix3d shown_rotation(const RestingPoints& points, std::span<const std::uint8_t> inlier,
                                             double fx, double fy) noexcept;

// Rms distance, px, of the places from their centre that the rotation is estimated from.
[[nodiscard]] double spread_of_turn_px(std::span<const Vector2> points, std::span<const double> readout_share) noexcept;

}  // namespace core

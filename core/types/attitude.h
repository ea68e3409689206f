#pragma once

#include <array>
#include <cmath>

namespace core {

// Orientation of a body (X forward, Y right, Z down) at one time: Hamilton quaternion w x y z that maps its axes to
// fixed axes. Any norm except zero.
struct AttitudeSample {
  double t_s = 0.0;  // on the frames' clock
  std::array<double, 4> wxyz{1.0, 0.0, 0.0, 0.0};
};

// Attitude from roll, pitch, yaw (aerospace): R_z(yaw) R_y(pitch) R_x(roll).
[[nodiscard]] inline std::array<double, 4> attitude_of(double roll_rad, double pitch_rad, double yaw_rad) noexcept {
  const double cr = std::cos(0.5 * roll_rad), sr = std::sin(0.5 * roll_rad);
  const double cp = std::cos(0.5 * pitch_rad), sp = std::sin(0.5 * pitch_rad);
  const double cy = std::cos(0.5 * yaw_rad), sy = std::sin(0.5 * yaw_rad);
  return {cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
          cr * cp * sy - sr * sp * cy};
}

}  // namespace core

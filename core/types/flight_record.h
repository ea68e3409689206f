#pragma once

#include <cstddef>
#include <vector>

namespace core {

// Parts of a recorded flight at a uniform rate, from a flight log and an inertial sensor. `from_s`: time of the first
// sample since the start of the flight; sample k is at from_s + k / rate_hz.

// Position of the aircraft relative to its mean.
struct FlightPath {
  double rate_hz = 0.0;
  double from_s = 0.0;
  std::vector<double> north_mm, east_mm, up_mm;
  double mean_heading_deg = 0.0;  // of the nose, clockwise from north

  [[nodiscard]] std::size_t n_samples() const noexcept { return north_mm.size(); }
};

// Rotation and acceleration of the aircraft in the axes of an inertial sensor: x forward, y left, z up. Angles are
// right-handed about x, y, z; yaw, pitch, roll in this order rotate the level frame to the sensor.
struct FlightAttitude {
  double rate_hz = 0.0;
  double from_s = 0.0;
  std::vector<double> roll_rad, pitch_rad, yaw_rad;  // about the means below, unwrapped
  double mean_roll_rad = 0.0, mean_pitch_rad = 0.0, mean_yaw_rad = 0.0;
  std::vector<double> x_m_s2, y_m_s2, z_m_s2;  // as measured: static and level, z is +g
  std::size_t n_replaced = 0;                  // accelerations that were exactly zero in all axes, i.e. not measured

  [[nodiscard]] std::size_t n_samples() const noexcept { return roll_rad.size(); }
};

}  // namespace core

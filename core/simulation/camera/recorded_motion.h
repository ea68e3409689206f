#pragma once

#include <array>
#include <vector>

#include "core/simulation/camera/uniform_spline.h"
#include "core/simulation/scene.h"
#include "core/types/flight_record.h"

namespace core::simulation {

// Use of a recorded flight as camera motion.
struct FlightUse {
  double facing_deg = 0.0;         // horizontal viewing direction of the camera, clockwise from north
  double gimbal_residual = 0.02;   // share of the aircraft's rotation that remains in the image
  double vibration_from_hz = 0.0;  // accelerations become displacement above this frequency; 0 = none
};

// Converts a flight's axes to the camera's: X right, Y down, Z in viewing direction.
//   position: x = -n sin h + e cos h, y = -up, z = n cos h + e sin h, h = facing
//   attitude: pitch about X = -pitch, yaw about Y = -yaw, roll about Z = roll, times gimbal_residual
//   vibration: accelerations, levelled by the angles and without gravity, divided by -(2 pi f)^2 above
//   vibration_from_hz (a raised-cosine edge from 0.8 of it); faded in and out over the first and last second. It is
//   used as the camera's own vibration: a gimbal does not remove translation. The camera looks in the nose's direction.
// Without attitude the motion has the path's rate and no rotation; with it the attitude's rate, the path interpolated.
// Path and attitude may be of different times of the flight, but the attitude must last as long as the path.
// Throws std::invalid_argument: values out of range or not finite, an attitude that is too short (names the
// seconds), vibration without accelerations or beyond 0.4 of their rate.
[[nodiscard]] RecordedMotion make_recorded_motion(const core::FlightPath& path, const core::FlightAttitude* attitude,
                                                  const FlightUse& use);

// Displacement of a record of accelerations, mm, zero below `from_hz`; the rules of make_recorded_motion.
[[nodiscard]] std::vector<double> displacement_mm(const std::vector<double>& acceleration_m_s2, double rate_hz,
                                                  double from_hz);

// RecordedMotion at any time. Time 0 is its first sample; past its end (and before its beginning) the record runs back
// and forth, mirrored in time: position continuous, velocity zero at the turns (UniformSpline states the error).
class RecordedPath {
 public:
  // Throws std::invalid_argument: no rate, unequal lengths, fewer than 4 samples, values that are not finite. A list
  // may be empty: zero.
  explicit RecordedPath(const RecordedMotion& motion);

  // Axis 0 .. 5: x, y, z in mm, pitch, yaw, roll in rad; 0 for any other.
  [[nodiscard]] double at(int axis, double t_s) const noexcept;
  [[nodiscard]] std::array<double, 6> rms() const noexcept { return rms_; }  // of the samples, about zero
  [[nodiscard]] double duration_s() const noexcept { return duration_s_; }   // first to last sample

 private:
  std::array<UniformSpline, 6> axis_;
  std::array<double, 6> rms_{};
  double duration_s_ = 0.0;
};

}  // namespace core::simulation

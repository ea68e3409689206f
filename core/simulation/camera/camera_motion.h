#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/simulation/camera/projection.h"
#include "core/simulation/camera/recorded_motion.h"
#include "core/simulation/injected/gimbal_vibration.h"
#include "core/simulation/injected/tailed_hover.h"
#include "core/simulation/scene.h"
#include "core/simulation/structure/periodic_signal.h"

namespace core::simulation {

// Pose of the camera at any time: mean pose, hover drift (independent Gaussian processes with the density of
// HoverParameters or TailedHoverParameters, one random stream each), a recorded flight, vibration of gimbal and
// rotors. All except the mean pose have zero mean over all time; at t = 0 the camera is at a random place of its
// drift.
class CameraMotion {
 public:
  explicit CameraMotion(const Scene& scene);

  [[nodiscard]] CameraPose at(double t_s) const noexcept;
  [[nodiscard]] bool rotates() const noexcept { return rotates_; }  // apart from the mean attitude
  [[nodiscard]] bool zooms() const noexcept { return zooms_; }
  // Deviations from the mean pose in camera axes over the clip: x, y, z in mm, pitch, yaw, roll in rad, zoom.
  [[nodiscard]] std::array<double, 7> rms() const;
  [[nodiscard]] std::array<double, 7> deviation(double t_s) const noexcept;

 private:
  [[nodiscard]] double rotor_phase(double t_s) const noexcept;

  CameraParameters mean_;
  Eigen::Matrix3d mean_attitude_;
  RotorParameters rotor_;
  double duration_s_, rate_hz_;
  bool rotates_, zooms_, vibrates_, tailed_, in_band_;
  std::array<PeriodicSignal, 7> hover_;
  TailedHover tailed_hover_;
  GimbalVibration gimbal_vibration_;
  std::optional<RecordedPath> flight_;
  PeriodicSignal rotor_wander_;  // cycles
  std::array<double, 3> rotor_phase_rad_{};
};

}  // namespace core::simulation

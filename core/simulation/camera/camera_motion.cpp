#include "core/simulation/camera/camera_motion.h"

#include <cmath>
#include <numbers>

#include "core/simulation/camera/drift.h"
#include "core/simulation/random_stream.h"

namespace core::simulation {
namespace {

constexpr std::array<const char*, 7> kStreamName{"hover_x",   "hover_y",    "hover_z",   "hover_pitch",
                                                 "hover_yaw", "hover_roll", "hover_zoom"};

std::array<double, 7> hover_rms(const HoverParameters& hover) {
  return {hover.x_rms_mm,    hover.y_rms_mm,     hover.z_rms_mm, hover.pitch_rms_rad,
          hover.yaw_rms_rad, hover.roll_rms_rad, hover.zoom_rms};
}

bool shakes(const RotorParameters& rotor) {
  return rotor.pitch_rms_rad > 0.0 || rotor.yaw_rms_rad > 0.0 || rotor.roll_rms_rad > 0.0;
}

bool any(const std::array<double, 3>& rms) { return rms[0] > 0.0 || rms[1] > 0.0 || rms[2] > 0.0; }

}  // namespace

CameraMotion::CameraMotion(const Scene& scene)
    : mean_(scene.camera),
      mean_attitude_(attitude(mean_.pitch_rad, mean_.yaw_rad, mean_.roll_rad)),
      rotor_(scene.rotor),
      duration_s_(scene.duration_s),
      rate_hz_(scene.camera.rate_hz),
      vibrates_(shakes(scene.rotor)) {
  const HoverParameters& hover = scene.hover;
  const std::array<double, 7> rms = hover_rms(hover);
  const TailedHoverParameters& tails = scene.tailed_hover;
  tailed_ = any(tails.rms_mm) || any(tails.rms_rad);
  if (tailed_) tailed_hover_ = TailedHover(tails, scene.seed, duration_s_);
  const VibrationParameters& vibration = scene.vibration;
  in_band_ = any(vibration.rms_mm) || any(vibration.rms_rad);
  if (in_band_) gimbal_vibration_ = GimbalVibration(vibration, scene.seed, duration_s_);
  rotates_ = vibrates_ || any(tails.rms_rad) || any(vibration.rms_rad) || rms[3] > 0.0 || rms[4] > 0.0 || rms[5] > 0.0;
  zooms_ = rms[6] > 0.0;
  if (scene.flight != nullptr) {
    flight_.emplace(*scene.flight);
    for (std::size_t i = 3; i < 6; ++i) rotates_ = rotates_ || flight_->rms()[i] > 0.0;
  }
  for (std::size_t i = 0; i < hover_.size(); ++i) {
    hover_[i] = drift({hover.corner_hz, hover.order, hover.limit_hz}, rms[i], RandomStream(scene.seed, kStreamName[i]),
                      duration_s_);
  }
  if (!vibrates_) return;
  rotor_wander_ = drift({rotor_.wander_corner_hz, 6.0, 10.0 * rotor_.wander_corner_hz}, rotor_.wander_rms_hz,
                        RandomStream(scene.seed, "rotor_wander"), duration_s_, true);
  RandomStream phase(scene.seed, "rotor_phase");
  for (double& rad : rotor_phase_rad_) rad = 2.0 * std::numbers::pi * phase.uniform();
}

double CameraMotion::rotor_phase(double t_s) const noexcept {
  return 2.0 * std::numbers::pi * (rotor_.frequency_hz * t_s + rotor_wander_.at(t_s));
}

std::array<double, 7> CameraMotion::deviation(double t_s) const noexcept {
  std::array<double, 7> value{};
  for (std::size_t i = 0; i < value.size(); ++i) value[i] = hover_[i].at(t_s);
  if (flight_) {
    for (int axis = 0; axis < 6; ++axis) value[static_cast<std::size_t>(axis)] += flight_->at(axis, t_s);
  }
  if (tailed_) {
    for (std::size_t i = 0; i < 6; ++i) value[i] += tailed_hover_.at(i, t_s);
  }
  if (in_band_) {
    for (std::size_t i = 0; i < 6; ++i) value[i] += gimbal_vibration_.at(i, t_s);
  }
  if (vibrates_) {
    const double phase = rotor_phase(t_s);
    const std::array<double, 3> rms{rotor_.pitch_rms_rad, rotor_.yaw_rms_rad, rotor_.roll_rms_rad};
    for (std::size_t i = 0; i < 3; ++i) {
      value[3 + i] += std::numbers::sqrt2 * rms[i] * std::sin(phase + rotor_phase_rad_[i]);
    }
  }
  return value;
}

CameraPose CameraMotion::at(double t_s) const noexcept {
  const auto [x, y, z, pitch, yaw, roll, zoom] = deviation(t_s);
  const Eigen::Vector3d moved = mean_attitude_ * Eigen::Vector3d(x, y, z);
  CameraPose pose{mean_.x_mm + moved.x(), mean_.y_mm + moved.y(), mean_.z_mm + moved.z(), mean_attitude_, 1.0 + zoom};
  if (rotates_) pose.attitude = mean_attitude_ * attitude(pitch, yaw, roll);
  return pose;
}

std::array<double, 7> CameraMotion::rms() const {
  std::array<double, 7> sum{};
  const auto n = static_cast<std::uint64_t>(duration_s_ * rate_hz_) + 1;
  for (std::uint64_t k = 0; k < n; ++k) {
    const std::array<double, 7> value = deviation(static_cast<double>(k) / rate_hz_);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += value[i] * value[i];
  }
  for (double& s : sum) s = std::sqrt(s / static_cast<double>(n));
  return sum;
}

}  // namespace core::simulation

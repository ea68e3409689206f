#include "core/geometry/attitude_prior.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace core {

namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kLeastSigma_rad = 1e-7;
constexpr double kDrift_rad2_per_s = 3e-9;  // of the bias: 0.003 degrees in one second
constexpr double kContradicts_sigmas = 6.0, kShareRate = 0.02, kMostContradicted = 0.5;

Quaterniond quaternion(const std::array<double, 4>& wxyz) noexcept { return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]}; }

// Camera axes (X right, Y down, Z forward) to those of a body with the same view (X forward, Y right, Z down).
Quaterniond from_camera() {
  Eigen::Matrix3d axes;
  axes << 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0;
  return Quaterniond(axes);
}

Vector3d rotation_vector(const Quaterniond& rotation) noexcept {
  const double sine = rotation.vec().norm();
  const double angle = 2.0 * std::atan2(sine, std::abs(rotation.w()));
  const double factor = sine > 1e-12 ? angle / sine : 2.0;
  return (rotation.w() < 0.0 ? -factor : factor) * rotation.vec();
}

Quaterniond rotation(const Vector3d& w) noexcept {
  const double angle = w.norm(), half = 0.5 * angle;
  const double factor = angle > 1e-12 ? std::sin(half) / angle : 0.5;
  return Quaterniond(std::cos(half), factor * w.x(), factor * w.y(), factor * w.z()).normalized();
}

}  // namespace

AttitudePrior::AttitudePrior(AttitudeConfig config)
    : config_(std::move(config)),
      to_body_(quaternion(attitude_of(config_.mount_rpy_rad[0], config_.mount_rpy_rad[1], config_.mount_rpy_rad[2])) *
               from_camera()),
      ring_(std::max({std::size_t{2}, config_.n_kept, config_.record.size()})) {
  config_.sigma_rad = std::max(kLeastSigma_rad, config_.sigma_rad);
  bias_variance_.setConstant(config_.sigma_rad * config_.sigma_rad);
  for (const AttitudeSample& sample : config_.record) take(sample);
  config_.record.clear();
}

void AttitudePrior::take(const AttitudeSample& sample) noexcept {
  const Quaterniond q = quaternion(sample.wxyz);
  const double length = q.norm();
  const bool sound = std::isfinite(sample.t_s) && std::isfinite(length) && length > 1e-6;
  if (!sound || (n_ > 0 && sample.t_s <= kept(n_ - 1).t_s)) {
    ++n_refused_;
    return;
  }
  if (n_ == ring_.size()) {
    first_ = (first_ + 1) % ring_.size();
    --n_;
  }
  ring_[(first_ + n_) % ring_.size()] = {sample.t_s, Quaterniond(q.coeffs() / length) * to_body_};
  ++n_;
}

std::optional<AttitudePrior::Turn> AttitudePrior::at(double t_s) const noexcept {
  if (n_ == 0 || !(t_s >= kept(0).t_s)) return std::nullopt;
  std::size_t low = 0, high = n_;  // index of the last sample that is not later
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (kept(middle).t_s <= t_s ? low : high) = middle;
  }
  const Kept& before = kept(low);
  if (low + 1 < n_) {
    const Kept& after = kept(low + 1);
    if (after.t_s - before.t_s > config_.most_gap_s && t_s > before.t_s) return std::nullopt;
    const double share = (t_s - before.t_s) / (after.t_s - before.t_s);
    return Turn{before.camera.slerp(share, after.camera), config_.sigma_rad};
  }
  const double age_s = t_s - before.t_s;
  if (age_s > config_.most_gap_s) return std::nullopt;
  double rate_rad_s = 0.0;
  if (low > 0) rate_rad_s = kept(low - 1).camera.angularDistance(before.camera) / (before.t_s - kept(low - 1).t_s);
  return Turn{before.camera, std::hypot(config_.sigma_rad, rate_rad_s * age_s)};
}

void AttitudePrior::before(CameraMotionEstimator& motion, double t_s) noexcept {
  measured_.reset();
  motion.measure_turn(std::nullopt);
  if (given_up_) return;
  const std::optional<Turn> now = at(t_s + config_.delay_s);
  if (!now) {
    ++n_without_;
    return;
  }
  if (!reference_) reference_ = now->camera * rotation(motion.estimate().segment<3>(kPitch));
  bias_variance_.array() += kDrift_rad2_per_s * std::max(0.0, std::min(1.0, t_s - last_s_));
  last_s_ = t_s;
  measured_ = rotation_vector(now->camera.conjugate() * *reference_) - bias_rad_;
  sigma_rad_ = now->sigma_rad;
  motion.measure_turn(TurnMeasurement{*measured_, sigma_rad_});
  ++n_used_;
}

void AttitudePrior::after(const CameraMotionEstimator& motion) noexcept {
  if (!measured_) return;
  const Vector3d left = *measured_ - motion.estimate().segment<3>(kPitch);
  if (!left.allFinite()) return;
  const bool against = left.cwiseAbs().maxCoeff() > kContradicts_sigmas * sigma_rad_;
  contradicted_ += kShareRate * ((against ? 1.0 : 0.0) - contradicted_);
  given_up_ = contradicted_ > kMostContradicted;
  if (!motion.sees_turns()) return;
  for (int i = 0; i < 3; ++i) {
    const double gain = bias_variance_(i) / (bias_variance_(i) + sigma_rad_ * sigma_rad_);
    bias_rad_(i) += gain * left(i);
    bias_variance_(i) *= 1.0 - gain;
  }
}

}  // namespace core

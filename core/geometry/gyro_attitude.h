#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "core/geometry/gyro_readout.h"

namespace core {

// Rotation by a rotation vector, radians.
inline Eigen::Quaterniond turn(const Eigen::Vector3d& rotation) {
  const double angle = rotation.norm();
  if (angle < 1e-12)
    return Eigen::Quaterniond(1.0, 0.5 * rotation.x(), 0.5 * rotation.y(), 0.5 * rotation.z()).normalized();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation / angle));
}

// Attitude over time, body to world, from a gyro's rates minus a bias: rates are linear between samples, a step rotates
// by their mean.
class GyroAttitude {
 public:
  GyroAttitude(const std::vector<GyroSample>& gyro, const Eigen::Vector3d& bias_rad_s)
      : gyro_(gyro), bias_(bias_rad_s) {
    at_.reserve(gyro.size());
    at_.push_back(Eigen::Quaterniond::Identity());
    for (std::size_t i = 1; i < gyro.size(); ++i) {
      const Eigen::Vector3d mean = 0.5 * (gyro[i - 1].rate_rad_s + gyro[i].rate_rad_s) - bias_;
      at_.push_back(at_.back() * turn(mean * (gyro[i].t_s - gyro[i - 1].t_s)));
    }
  }
  [[nodiscard]] Eigen::Quaterniond operator()(double t_s) const {
    const auto after = std::upper_bound(gyro_.begin() + 1, gyro_.end() - 1, t_s,
                                        [](double t, const GyroSample& sample) { return t < sample.t_s; });
    const auto i = static_cast<std::size_t>(after - gyro_.begin() - 1);
    const double step_s = gyro_[i + 1].t_s - gyro_[i].t_s, share = (t_s - gyro_[i].t_s) / step_s;
    const Eigen::Vector3d middle =
        gyro_[i].rate_rad_s + 0.5 * share * (gyro_[i + 1].rate_rad_s - gyro_[i].rate_rad_s) - bias_;
    return at_[i] * turn(middle * (t_s - gyro_[i].t_s));
  }

 private:
  const std::vector<GyroSample>& gyro_;
  Eigen::Vector3d bias_;
  std::vector<Eigen::Quaterniond> at_;
};

}  // namespace core

#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "core/geometry/gyro_readout.h"

namespace test_support {

inline constexpr double kFrame_s = 1.0 / 30.0, kFocal_px = 580.0, kWidth_px = 800.0, kHeight_px = 600.0;
inline constexpr double kOffset_s = 0.012;

// Body rates of a hand that shakes: some tones about each axis.
inline Eigen::Vector3d rate_at(double t_s, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  for (int tone = 0; tone < 5; ++tone) {
    for (int axis = 0; axis < 3; ++axis) {
      const double hz = 0.7 + 7.0 * unit(random), phase = 6.283 * unit(random);
      rate[axis] += 0.25 * std::sin(6.283185307 * hz * t_s + phase);
    }
  }
  return rate;
}

// A shaken camera that moves forward through points at 4 ... 60 m; its gyro has the orientation of a phone's.
class ShakenCamera {
 public:
  ShakenCamera(double readout_s, double noise_px, std::uint64_t seed, int n_pairs = 28)
      : readout_s_(readout_s), end_s_(n_pairs * kFrame_s + 1.07), random_(seed) {
    constexpr double kStep_s = 2e-4;
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
    for (double t_s = kStart_s; t_s < end_s_; t_s += kStep_s) {
      turns_.push_back(q);
      const Eigen::Vector3d middle = rate_at(t_s + 0.5 * kStep_s, seed) * kStep_s;
      q = (q * Eigen::Quaterniond(Eigen::AngleAxisd(middle.norm(), middle.normalized()))).normalized();
    }
    for (double t_s = kStart_s + 0.01; t_s < end_s_ - 0.01; t_s += 0.0025) {
      gyro.push_back({t_s + kOffset_s, rate_at(t_s, seed) + Eigen::Vector3d(0.004, -0.003, 0.002)});
    }
    for (int k = 0; k < n_pairs; ++k) add_pair(k * kFrame_s, noise_px);
  }
  std::vector<core::FramePair> pairs;
  std::vector<core::GyroSample> gyro;
  core::GyroReadoutConfig config{kFocal_px, 0.5 * (kWidth_px - 1.0), 0.5 * (kHeight_px - 1.0), kWidth_px, 0.1};

 private:
  static constexpr double kStart_s = -0.5;

  // Camera axes to the world; the gyro's X is the camera's -Y, its Y the camera's -X, its Z the camera's -Z.
  [[nodiscard]] Eigen::Quaterniond camera_at(double t_s) const {
    Eigen::Matrix3d axes;
    axes << 0.0, -1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, -1.0;
    const auto i = static_cast<std::size_t>((t_s - kStart_s) / 2e-4);
    return turns_[i] * Eigen::Quaterniond(Eigen::Matrix3d(axes.transpose()));
  }
  [[nodiscard]] core::Vector2 seen(const Eigen::Vector3d& world, double frame_s) const {
    core::Vector2 at{0.0, 0.5 * kHeight_px};
    for (int round = 0; round < 6; ++round) {
      const double t_s = frame_s + readout_s_ * at.v / kHeight_px;
      const Eigen::Vector3d place(0.2 * t_s, -0.1 * t_s, 3.0 * t_s);
      const Eigen::Vector3d ray = camera_at(t_s).conjugate() * (world - place);
      at = {config.cx_px + kFocal_px * ray.x() / ray.z(), config.cy_px + kFocal_px * ray.y() / ray.z()};
    }
    return at;
  }
  void add_pair(double frame_s, double noise_px) {
    core::FramePair pair;
    pair.from_s = frame_s;
    pair.to_s = frame_s + kFrame_s;
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::normal_distribution<double> noise(0.0, noise_px);
    for (int i = 0; i < 28; ++i) {
      const double depth = 4.0 * std::pow(15.0, unit(random_));
      const Eigen::Vector3d ray{(unit(random_) - 0.5) * kWidth_px / kFocal_px,
                                (unit(random_) - 0.5) * kHeight_px / kFocal_px, 1.0};
      const Eigen::Vector3d world = camera_at(frame_s) * (depth * ray) + Eigen::Vector3d(0.2, -0.1, 3.0) * frame_s;
      core::Vector2 from = seen(world, pair.from_s), to = seen(world, pair.to_s);
      from.u += noise(random_), from.v += noise(random_), to.u += noise(random_), to.v += noise(random_);
      if (i % 10 == 0) to.u += 20.0 * unit(random_);  // an independently moving point
      pair.points.push_back({from, to, from.v / kHeight_px, to.v / kHeight_px});
    }
    pair.held_out = pairs.size() % 4 == 3;
    pairs.push_back(pair);
  }

  double readout_s_, end_s_;
  std::mt19937_64 random_;
  std::vector<Eigen::Quaterniond> turns_;
};

}  // namespace test_support

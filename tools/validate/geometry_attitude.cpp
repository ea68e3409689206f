#include "tools/validate/geometry_attitude.h"

#include <Eigen/Geometry>
#include <numbers>

namespace tools {

namespace {
constexpr double kStep_s = 0.02, kBefore_s = 0.1;
}

ToldAttitude::ToldAttitude(const core::simulation::CameraMotion& motion, double sigma_deg, std::uint64_t seed)
    : motion_(motion),
      sigma_rad_(sigma_deg * std::numbers::pi / 180.0),
      next_s_(-kBefore_s),
      noise_(seed, "attitude") {}

const std::vector<core::AttitudeSample>& ToldAttitude::until(double t_s) {
  Eigen::Matrix3d body_to_camera;  // X ahead, Y right, Z down to X right, Y down, Z ahead
  body_to_camera << 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0;
  samples_.clear();
  for (; next_s_ <= t_s; next_s_ += kStep_s) {
    const Eigen::Vector3d w = sigma_rad_ * Eigen::Vector3d{noise_.gaussian(), noise_.gaussian(), noise_.gaussian()};
    const Eigen::Quaterniond q = Eigen::Quaterniond(Eigen::Matrix3d(motion_.at(next_s_).attitude * body_to_camera)) *
                                 Eigen::Quaterniond(Eigen::AngleAxisd(w.norm(), w.stableNormalized()));
    samples_.push_back({next_s_, {q.w(), q.x(), q.y(), q.z()}});
  }
  return samples_;
}

}  // namespace tools

#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "core/geometry/camera_fit.h"
#include "core/simulation/camera/lens.h"

namespace tests {

// A camera with the simulator's lens, which is independent of core/geometry.
struct DrawnCamera {
  int width_px = 640, height_px = 480;
  double fx = 620.0, fy = 615.0, cx = 327.3, cy = 236.1;
  core::simulation::LensParameters lens;

  [[nodiscard]] core::Vector2 see(const Eigen::Vector3d& p) const {
    const auto ray = core::simulation::distort(lens, {p.x() / p.z(), p.y() / p.z()});
    return {cx + fx * ray.x, cy + fy * ray.y};
  }
  [[nodiscard]] core::simulation::Ray ray(double u, double v) const {
    return core::simulation::undistort(lens, {(u - cx) / fx, (v - cy) / fy});
  }
};

struct DrawnPose {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation_mm;  // of the first inner corner
};

// The board's middle at `middle_mm`, tilted about x, y and then rotated about the optical axis.
inline DrawnPose board_pose(const core::ChessBoard& board, const Eigen::Vector3d& middle_mm, double tilt_x_deg,
                            double tilt_y_deg, double turn_deg) {
  const auto by = [](double deg, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(deg * std::numbers::pi / 180.0, axis).toRotationMatrix();
  };
  const Eigen::Matrix3d rotation = by(turn_deg, Eigen::Vector3d::UnitZ()) * by(tilt_y_deg, Eigen::Vector3d::UnitY()) *
                                   by(tilt_x_deg, Eigen::Vector3d::UnitX());
  const Eigen::Vector3d middle(0.5 * (board.columns - 1) * board.square_mm, 0.5 * (board.rows - 1) * board.square_mm,
                               0.0);
  return {rotation, middle_mm - rotation * middle};
}

inline Eigen::Vector3d corner_in_camera(const core::ChessBoard& board, const DrawnPose& pose, std::size_t i) {
  const auto columns = static_cast<std::size_t>(board.columns);
  const Eigen::Vector3d p(static_cast<double>(i % columns) * board.square_mm,
                          static_cast<double>(i / columns) * board.square_mm, 0.0);
  return pose.rotation * p + pose.translation_mm;
}

// Boards at 5 x 3 places of the image, of all sizes, tilted to all sides by up to 32 degrees; whole in the picture.
inline std::vector<DrawnPose> spread_poses(const core::ChessBoard& board, const DrawnCamera& camera, int n) {
  std::vector<DrawnPose> poses;
  std::mt19937 random(5);
  const auto uniform = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  while (static_cast<int>(poses.size()) < n) {
    const auto ray = camera.ray(uniform(0.15, 0.85) * camera.width_px, uniform(0.2, 0.8) * camera.height_px);
    const double z = uniform(280.0, 520.0);
    const DrawnPose pose =
        board_pose(board, {ray.x * z, ray.y * z, z}, uniform(-32.0, 32.0), uniform(-32.0, 32.0), uniform(-30.0, 30.0));
    bool whole = true;
    for (std::size_t i = 0; i < board.n_corners(); ++i) {
      const core::Vector2 p = camera.see(corner_in_camera(board, pose, i));
      whole = whole && p.u > 30.0 && p.v > 30.0 && p.u < camera.width_px - 30.0 && p.v < camera.height_px - 30.0;
    }
    if (whole) poses.push_back(pose);
  }
  return poses;
}

class BoardPainter {
 public:
  explicit BoardPainter(const DrawnCamera& camera) : camera_(camera) {
    for (int v = 0; v <= camera.height_px; ++v) {
      for (int u = 0; u <= camera.width_px; ++u) rays_.push_back(camera.ray(u - 0.5, v - 0.5));
    }
  }

  // 4 x 4 samples per pixel (rays between its corners by bilinear interpolation), slight blur, white noise.
  [[nodiscard]] cv::Mat paint(const core::ChessBoard& board, const DrawnPose& pose, double noise_grey,
                              unsigned seed) const {
    cv::Mat light(camera_.height_px, camera_.width_px, CV_32F);
    for (int v = 0; v < camera_.height_px; ++v) {
      for (int u = 0; u < camera_.width_px; ++u) light.at<float>(v, u) = static_cast<float>(pixel(board, pose, u, v));
    }
    cv::GaussianBlur(light, light, {5, 5}, 0.6);
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0.0, noise_grey);
    cv::Mat out(light.size(), CV_8U);
    for (int v = 0; v < light.rows; ++v) {
      for (int u = 0; u < light.cols; ++u)
        out.at<std::uint8_t>(v, u) =
            cv::saturate_cast<std::uint8_t>(static_cast<double>(light.at<float>(v, u)) + normal(random));
    }
    return out;
  }

 private:
  [[nodiscard]] double pixel(const core::ChessBoard& board, const DrawnPose& pose, int u, int v) const {
    constexpr int kSamples = 4;
    const auto wide = static_cast<std::size_t>(camera_.width_px) + 1;
    const std::size_t at = static_cast<std::size_t>(v) * wide + static_cast<std::size_t>(u);
    double sum = 0.0;
    for (int j = 0; j < kSamples; ++j) {
      for (int i = 0; i < kSamples; ++i) {
        const double a = (i + 0.5) / kSamples, b = (j + 0.5) / kSamples;
        const auto between = [&](double core::simulation::Ray::*x) {
          return (1 - b) * ((1 - a) * rays_[at].*x + a * rays_[at + 1].*x) +
                 b * ((1 - a) * rays_[at + wide].*x + a * rays_[at + wide + 1].*x);
        };
        sum += grey(board, pose, between(&core::simulation::Ray::x), between(&core::simulation::Ray::y));
      }
    }
    return sum / (kSamples * kSamples);
  }

  [[nodiscard]] static double grey(const core::ChessBoard& board, const DrawnPose& pose, double x, double y) {
    const Eigen::Vector3d ray(x, y, 1.0);
    const double depth = pose.rotation.col(2).dot(pose.translation_mm) / pose.rotation.col(2).dot(ray);
    const Eigen::Vector3d p = pose.rotation.transpose() * (depth * ray - pose.translation_mm) / board.square_mm;
    if (depth <= 0.0 || p.x() < -2.0 || p.y() < -2.0 || p.x() > board.columns + 1.0 || p.y() > board.rows + 1.0)
      return 100.0;
    if (p.x() < -1.0 || p.y() < -1.0 || p.x() > board.columns || p.y() > board.rows) return 220.0;
    const int square = static_cast<int>(std::floor(p.x())) + static_cast<int>(std::floor(p.y()));
    return square % 2 == 0 ? 30.0 : 220.0;
  }

  DrawnCamera camera_;
  std::vector<core::simulation::Ray> rays_;
};

}  // namespace tests

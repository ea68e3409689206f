#include "core/simulation/camera/lens.h"

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include <vector>

#include "core/simulation/camera/projection.h"

namespace core::simulation {
namespace {

using Model = LensParameters::Model;

class Lens : public testing::TestWithParam<LensParameters> {};

TEST_P(Lens, UndoesWhatItDoes) {
  for (double x = -0.6; x <= 0.6; x += 0.1) {
    for (double y = -0.4; y <= 0.4; y += 0.1) {
      const Ray back = undistort(GetParam(), distort(GetParam(), {x, y}));
      EXPECT_NEAR(back.x, x, 1e-12);
      EXPECT_NEAR(back.y, y, 1e-12);
    }
  }
}

TEST_P(Lens, BendsAsOpenCvDoes) {
  std::vector<cv::Point2d> seen;
  const std::vector<cv::Point3d> points{{0.3, -0.2, 1.0}, {-0.5, 0.4, 1.0}, {0.01, 0.02, 1.0}};
  const cv::Mat zero = cv::Mat::zeros(3, 1, CV_64F), unit = cv::Mat::eye(3, 3, CV_64F);
  const auto& k = GetParam().k;
  if (GetParam().model == Model::kEquidistant) {
    std::vector<cv::Point2d> flat;
    for (const auto& p : points) flat.emplace_back(p.x, p.y);
    cv::fisheye::distortPoints(flat, seen, unit, cv::Mat(cv::Vec4d(k[0], k[1], k[2], k[3])));
  } else {
    cv::projectPoints(points, zero, zero, unit, std::vector<double>(k.begin(), k.end()), seen);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Ray ray = distort(GetParam(), {points[i].x, points[i].y});
    EXPECT_NEAR(ray.x, seen[i].x, 1e-12);
    EXPECT_NEAR(ray.y, seen[i].y, 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, Lens,
                         testing::Values(LensParameters{},
                                         LensParameters{Model::kRadialTangential, {-0.12, 0.03, 1e-3, -8e-4, 0.004}},
                                         LensParameters{Model::kEquidistant, {-0.02, 0.004, -0.001, 2e-4, 0.0}}));

TEST(ReadoutShare, RunsTheWayTheSensorIsRead) {
  CameraParameters camera;
  const ImagePoint pixel{480.0, 270.0};
  EXPECT_DOUBLE_EQ(readout_share(camera, pixel), 0.25);
  camera.readout_direction = core::ReadoutDirection::kUp;
  EXPECT_DOUBLE_EQ(readout_share(camera, pixel), -0.25);
  camera.readout_direction = core::ReadoutDirection::kRight;
  EXPECT_DOUBLE_EQ(readout_share(camera, pixel), 0.25);
  camera.readout_direction = core::ReadoutDirection::kLeft;
  EXPECT_DOUBLE_EQ(readout_share(camera, pixel), -0.25);
}

}  // namespace
}  // namespace core::simulation

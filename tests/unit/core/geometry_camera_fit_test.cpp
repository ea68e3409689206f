#include "core/geometry/camera_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <opencv2/calib3d.hpp>
#include <random>
#include <stdexcept>

#include "core/geometry/lens_fault.h"
#include "tests/support/board_image.h"

namespace core {
namespace {

using tests::DrawnCamera;
using tests::DrawnPose;
using Lens = simulation::LensParameters;
constexpr double kNoisePx = 0.1;

std::vector<BoardView> views_of(const ChessBoard& board, const DrawnCamera& camera, const std::vector<DrawnPose>& poses,
                                unsigned seed, double noise_px = kNoisePx) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, noise_px);
  std::vector<BoardView> views;
  for (const DrawnPose& pose : poses) {
    BoardView& view = views.emplace_back();
    for (std::size_t i = 0; i < board.n_corners(); ++i) {
      const Vector2 p = camera.see(tests::corner_in_camera(board, pose, i));
      view.push_back({p.u + normal(random), p.v + normal(random)});
    }
  }
  return views;
}

std::vector<double> errors_in_sigma(const CameraFit& fit, const DrawnCamera& truth) {
  const CameraModel& c = fit.camera;
  std::vector<double> errors{(c.fx - truth.fx) / fit.sigma[0], (c.fy - truth.fy) / fit.sigma[1],
                             (c.cx - truth.cx) / fit.sigma[2], (c.cy - truth.cy) / fit.sigma[3]};
  for (std::size_t i = 0; static_cast<int>(i) < fit.n_coefficients; ++i)
    errors.push_back((c.distortion[i] - truth.lens.k[i]) / fit.sigma[4 + i]);
  return errors;
}

CameraFit fit(const ChessBoard& board, const DrawnCamera& camera, const std::vector<BoardView>& views) {
  const bool fisheye = camera.lens.model == Lens::Model::kEquidistant;
  return fit_camera(board, views, fisheye ? LensModel::kEquidistant : LensModel::kRadialTangential, camera.width_px,
                    camera.height_px);
}

class CameraFitOf : public testing::TestWithParam<Lens> {
 protected:
  ChessBoard board_;
  DrawnCamera camera_{640, 480, 620.0, 615.0, 327.3, 236.1, GetParam()};
};

TEST_P(CameraFitOf, FindsTheTruthOfExactCorners) {
  const auto found = fit(board_, camera_, views_of(board_, camera_, tests::spread_poses(board_, camera_, 12), 1, 0.0));
  EXPECT_EQ(found.n_coefficients, camera_.lens.model == Lens::Model::kEquidistant ? 4 : 5);
  EXPECT_LT(found.rms_px, 1e-5);  // OpenCV's initial values have single precision; this fit's do not
  EXPECT_NEAR(found.camera.fx, camera_.fx, 1e-4);
  EXPECT_NEAR(found.camera.cy, camera_.cy, 1e-4);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(found.camera.distortion[i], camera_.lens.k[i], 1e-5) << i;
}

// Sum of squares of 8 x (8 or 9) errors in units of their sigmas: its mean is their number, its standard deviation
// sqrt(2 x number) for independent parameters; correlated ones scatter more, which four deviations allow for.
TEST_P(CameraFitOf, StatesItsErrors) {
  const auto poses = tests::spread_poses(board_, camera_, 12);
  double sum = 0.0, n = 0.0, noise = 0.0;
  constexpr unsigned kSeeds = 8;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const CameraFit found = fit(board_, camera_, views_of(board_, camera_, poses, seed));
    for (const double error : errors_in_sigma(found, camera_)) {
      EXPECT_LT(std::abs(error), 4.5);
      sum += error * error;
      n += 1.0;
    }
    noise += found.corner_sigma_px / kSeeds;
  }
  EXPECT_NEAR(sum / n, 1.0, 4.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(noise, kNoisePx, 0.003);
}

INSTANTIATE_TEST_SUITE_P(Lenses, CameraFitOf,
                         testing::Values(Lens{Lens::Model::kRadialTangential, {-0.28, 0.09, 1e-3, -8e-4, 0.0}},
                                         Lens{Lens::Model::kRadialTangential, {-0.3, 0.2, 1e-3, -8e-4, -0.2}},
                                         Lens{Lens::Model::kEquidistant, {-0.03, 0.05, -0.08, 0.04, 0.0}}));

// OpenCV states standard deviations for its own radial-tangential fit.
TEST(CameraFit, AgreesWithOpencvAndItsDeviations) {
  const ChessBoard board;
  DrawnCamera camera;
  camera.lens = {Lens::Model::kRadialTangential, {-0.3, 0.2, 1e-3, -8e-4, -0.2}};
  const auto views = views_of(board, camera, tests::spread_poses(board, camera, 12), 3);
  const CameraFit found = fit(board, camera, views);
  std::vector<std::vector<cv::Point3f>> objects(views.size());
  std::vector<std::vector<cv::Point2f>> images(views.size());
  for (std::size_t k = 0; k < views.size(); ++k) {
    for (std::size_t i = 0; i < views[k].size(); ++i) {
      objects[k].emplace_back(static_cast<float>(i % 9) * 25.0F, static_cast<float>(i / 9) * 25.0F, 0.0F);
      images[k].emplace_back(static_cast<float>(views[k][i].u), static_cast<float>(views[k][i].v));
    }
  }
  cv::Mat k, d, intrinsics, extrinsics, per_view;
  std::vector<cv::Mat> r, t;
  const double rms = cv::calibrateCamera(objects, images, {640, 480}, k, d, r, t, intrinsics, extrinsics, per_view, 0,
                                         {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-12});
  ASSERT_EQ(found.n_coefficients, 5);
  EXPECT_NEAR(found.rms_px, rms, 1e-4 * rms);
  EXPECT_NEAR(found.camera.fx, k.at<double>(0, 0), 0.05 * found.sigma[0]);
  // OpenCV 4.6 uses the number of corners as number of equations, although each corner gives two; 4.10 does not.
  const double n_corners = 12.0 * 54.0, n_parameters = 9.0 + 12.0 * 6.0;
  constexpr bool kTakesCorners = CV_VERSION_MAJOR < 4 || (CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR < 10);
  const double points_for_coordinates =
      kTakesCorners ? std::sqrt((n_corners - n_parameters) / (2.0 * n_corners - n_parameters)) : 1.0;
  for (std::size_t i = 0; i < found.sigma.size(); ++i)
    EXPECT_NEAR(found.sigma[i], points_for_coordinates * intrinsics.at<double>(static_cast<int>(i)),
                0.03 * found.sigma[i])
        << i;
  for (std::size_t i = 0; i < views.size(); ++i)
    EXPECT_NEAR(found.view_rms_px[i], per_view.at<double>(static_cast<int>(i)), 1e-3);
}

TEST(CameraFit, ABoardThatOnlyFacesTheCameraLeavesTheFocalLengthOpen) {
  const ChessBoard board;
  const DrawnCamera camera;
  std::vector<DrawnPose> flat, tilted;
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector3d middle(-60.0 + 40.0 * (i % 4), -40.0 + 40.0 * static_cast<double>(i / 4), 400.0 + 8.0 * i);
    flat.push_back(tests::board_pose(board, middle, 0.5, -0.5, 10.0 * i));
    tilted.push_back(tests::board_pose(board, middle, i % 2 == 0 ? 30.0 : -25.0, i % 3 == 0 ? 25.0 : -30.0, 10.0 * i));
  }
  const CameraFit poor = fit(board, camera, views_of(board, camera, flat, 1));
  const CameraFit good = fit(board, camera, views_of(board, camera, tilted, 1));
  EXPECT_GT(poor.sigma[0], 10.0 * good.sigma[0]);
  EXPECT_LT(poor.condition, 0.1 * good.condition);
  EXPECT_LT(poor.tilt_deg[0], 5.0);
  EXPECT_NEAR(good.tilt_deg[1], std::acos(std::cos(25.0 * 0.0174532925) * std::cos(30.0 * 0.0174532925)) / 0.0174532925,
              0.5);
}

TEST(CameraFit, RefusesTooFewOrBrokenViews) {
  const ChessBoard board;
  const DrawnCamera camera;
  auto views = views_of(board, camera, tests::spread_poses(board, camera, 4), 1);
  EXPECT_THROW((void)fit(board, camera, {views[0], views[1]}), std::runtime_error);
  auto broken = views;
  broken[1][5].u = std::nan("");
  EXPECT_THROW((void)fit(board, camera, broken), std::runtime_error);
  broken = views;
  broken[2].pop_back();
  EXPECT_THROW((void)fit(board, camera, broken), std::runtime_error);
}

// All corners on one line, or all in one point: no solution is possible, and none is returned.
TEST(CameraFit, RefusesBoardsWithoutArea) {
  const ChessBoard board;
  for (const double height : {0.0, 0.1}) {
    std::vector<BoardView> views(5);
    for (std::size_t k = 0; k < views.size(); ++k) {
      for (std::size_t i = 0; i < board.n_corners(); ++i)
        views[k].push_back({100.0 + height * 40.0 * static_cast<double>(i), 100.0 + 10.0 * static_cast<double>(k)});
    }
    for (const LensModel lens : {LensModel::kRadialTangential, LensModel::kEquidistant})
      EXPECT_THROW((void)fit_camera(board, views, lens, 640, 480), std::runtime_error);
  }
}

TEST(SpreadViews, LeavesOutWhatShowsNothingNew) {
  const ChessBoard board;
  const DrawnCamera camera;
  auto views = views_of(board, camera, tests::spread_poses(board, camera, 10), 1);
  const std::vector<BoardView> once = views;
  for (int copies = 0; copies < 3; ++copies) views.insert(views.end(), once.begin(), once.end());
  const auto all = spread_views(board, views, 640, 480, 100);
  EXPECT_EQ(all.size(), spread_views(board, once, 640, 480, 100).size());
  EXPECT_GE(all.size(), 8U);
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
  EXPECT_EQ(spread_views(board, views, 640, 480, 5).size(), 5U);
  EXPECT_TRUE(spread_views(board, {}, 640, 480, 5).empty());
}

}  // namespace
}  // namespace core

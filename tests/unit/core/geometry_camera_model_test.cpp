#include "core/geometry/camera_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/geometry/lens_fault.h"
#include "core/simulation/camera/lens.h"

namespace core {
namespace {

CameraModel camera(std::array<double, 8> distortion, LensModel lens = LensModel::kRadialTangential) {
  return {2100.0, 2080.0, 961.5, 542.0, distortion, lens};
}
CameraModel fisheye(std::array<double, 8> distortion) {
  return {600.0, 590.0, 961.5, 542.0, distortion, LensModel::kEquidistant};
}

TEST(CameraModel, WithoutCalibrationPointsPassThrough) {
  const CameraModel none;
  EXPECT_FALSE(none.calibrated());
  EXPECT_EQ(none.undistort({12.5, -3.0}).u, 12.5);
  EXPECT_EQ(none.distort({12.5, -3.0}).v, -3.0);
}

TEST(CameraModel, ThePrincipalPointStaysWhereItIs) {
  const CameraModel model = camera({-0.3, 0.1, 0.001, -0.002, 0.01});
  const Vector2 centre = model.distort({961.5, 542.0});
  EXPECT_NEAR(centre.u, 961.5, 1e-12);
  EXPECT_NEAR(centre.v, 542.0, 1e-12);
}

// By hand at x = 0.2, y = 0.1, r2 = 0.05.
TEST(CameraModel, DistortsByBrownsFormula) {
  const CameraModel model = camera({-0.3, 0.1, 0.001, -0.002, 0.5});
  const double radial = 1.0 - 0.3 * 0.05 + 0.1 * 0.0025 + 0.5 * 0.000125;
  const double x = 0.2 * radial + 2.0 * 0.001 * 0.2 * 0.1 - 0.002 * (0.05 + 2.0 * 0.04);
  const double y = 0.1 * radial + 0.001 * (0.05 + 2.0 * 0.01) + 2.0 * -0.002 * 0.2 * 0.1;
  const Vector2 raw = model.distort({961.5 + 2100.0 * 0.2, 542.0 + 2080.0 * 0.1});
  EXPECT_NEAR(raw.u, 961.5 + 2100.0 * x, 1e-9);
  EXPECT_NEAR(raw.v, 542.0 + 2080.0 * y, 1e-9);
}

void expect_undone(const CameraModel& model) {
  for (double u = 0.0; u <= 1920.0; u += 120.0) {
    for (double v = 0.0; v <= 1080.0; v += 90.0) {
      const Vector2 raw = model.distort(model.undistort({u, v}));
      EXPECT_NEAR(raw.u, u, 1e-8) << model.distortion[0] << " at " << u << ", " << v;
      EXPECT_NEAR(raw.v, v, 1e-8) << model.distortion[0] << " at " << u << ", " << v;
    }
  }
}

TEST(CameraModel, DistortUndoesUndistortInTheWholeImage) {
  const std::vector<std::array<double, 8>> lenses{{0.0},
                                                  {-0.35, 0.12, 0.001, -0.002, 0.0},
                                                  {0.2, -0.1, -0.001, 0.002, 0.05},
                                                  {-0.4, 0.2, 0.0, 0.0, -0.05},
                                                  {0.5, 0.3, 0.01, 0.01, 0.2},
                                                  {12.1, 8.0, 1e-4, -1e-4, 0.3, 12.4, 11.0, 2.0}};
  for (const auto& lens : lenses) {
    ASSERT_FALSE(lens_fault(camera(lens), 1920, 1080)) << lens[0];
    expect_undone(camera(lens));
  }
}

TEST(CameraModel, UndoesAFisheyeUpToNinetyDegrees) {
  for (const std::array<double, 8> k :
       {std::array<double, 8>{}, {-0.02, 0.004, -0.001, 2e-4}, {0.3, -0.15, 0.05, -0.006}}) {
    const CameraModel model = fisheye(k);
    for (double angle_deg = 0.0; angle_deg < 89.5; angle_deg += 2.5) {
      const double r = std::tan(angle_deg * std::acos(-1.0) / 180.0);
      const Vector2 ideal{961.5 + 600.0 * 0.6 * r, 542.0 + 590.0 * 0.8 * r};
      const Vector2 back = model.undistort(model.distort(ideal));
      EXPECT_NEAR(back.u, ideal.u, 1e-9 * (1.0 + r) * 600.0 * (1.0 + r)) << angle_deg;
      EXPECT_NEAR(back.v, ideal.v, 1e-9 * (1.0 + r) * 600.0 * (1.0 + r)) << angle_deg;
    }
  }
}

// The simulator's lens is implemented independently of this one.
TEST(CameraModel, AgreesWithTheSimulatorsLens) {
  using Lens = simulation::LensParameters;
  const Lens lenses[] = {{Lens::Model::kRadialTangential, {-0.12, 0.03, 1e-3, -8e-4, 0.004}},
                         {Lens::Model::kEquidistant, {-0.02, 0.004, -0.001, 2e-4, 0.0}}};
  for (const Lens& lens : lenses) {
    CameraModel model{1000.0, 1000.0, 0.0, 0.0, {}, LensModel::kRadialTangential};
    if (lens.model == Lens::Model::kEquidistant) model.lens = LensModel::kEquidistant;
    std::copy(lens.k.begin(), lens.k.end(), model.distortion.begin());
    for (double x = -0.8; x <= 0.8; x += 0.2) {
      for (double y = -0.5; y <= 0.5; y += 0.25) {
        const simulation::Ray there = simulation::distort(lens, {x, y});
        const Vector2 raw = model.distort({1000.0 * x, 1000.0 * y});
        EXPECT_NEAR(raw.u, 1000.0 * there.x, 1e-9);
        EXPECT_NEAR(raw.v, 1000.0 * there.y, 1e-9);
        const Vector2 back = model.undistort({1000.0 * there.x, 1000.0 * there.y});
        EXPECT_NEAR(back.u, 1000.0 * x, 1e-7);
        EXPECT_NEAR(back.v, 1000.0 * y, 1e-7);
      }
    }
  }
}

TEST(CameraModel, DerivativesAreThoseOfTheDistortion) {
  for (const CameraModel& model :
       {camera({12.1, 8.0, 0.01, -0.02, 0.3, 12.4, 11.0, 2.0}), fisheye({-0.02, 0.04, -0.01, 2e-3})}) {
    constexpr double kStep = 1e-6;
    const LensBend at = bend(model, 0.3, -0.4);
    const LensBend right = bend(model, 0.3 + kStep, -0.4), left = bend(model, 0.3 - kStep, -0.4);
    const LensBend below = bend(model, 0.3, -0.4 + kStep), above = bend(model, 0.3, -0.4 - kStep);
    EXPECT_NEAR(at.dx_dx, (right.x - left.x) / (2 * kStep), 1e-8);
    EXPECT_NEAR(at.dy_dx, (right.y - left.y) / (2 * kStep), 1e-8);
    EXPECT_NEAR(at.dx_dy, (below.x - above.x) / (2 * kStep), 1e-8);
    EXPECT_NEAR(at.dy_dy, (below.y - above.y) / (2 * kStep), 1e-8);
  }
}

TEST(CameraModel, WhereTheLensShowsNoRayThereIsNoPoint) {
  const CameraModel barrel = camera({-1.2});  // folds at r = 0.527, seen at 0.3514: 738 px
  EXPECT_TRUE(std::isfinite(barrel.undistort({961.5 + 737.0, 542.0}).u));
  EXPECT_TRUE(std::isnan(barrel.undistort({961.5 + 739.0, 542.0}).u));
  // Mustache distortion: it rises again farther out, but those rays do not continue the image's.
  const CameraModel mustache = camera({-2.0, 0.0, 0.0, 0.0, 2.0});
  EXPECT_TRUE(std::isnan(mustache.undistort({961.5 + 2100.0, 542.0}).u));
  EXPECT_TRUE(std::isnan(fisheye({}).undistort({961.5 + 600.0 * 1.6, 542.0}).u));
  EXPECT_TRUE(std::isnan(camera({-0.1}).undistort({std::nan(""), 5.0}).u));
  EXPECT_TRUE(std::isnan(fisheye({}).undistort({std::nan(""), 5.0}).u));
}

TEST(LensFault, FindsTheRadiusAtWhichTheImageFolds) {
  const auto fault = lens_fault({2100.0, 2100.0, 959.5, 539.5, {-1.2}}, 1920, 1080);
  ASSERT_TRUE(fault);
  EXPECT_NEAR(fault->radius_px, 2100.0 * 2.0 / 3.0 / std::sqrt(3.6), 1.0);
  EXPECT_NEAR(std::hypot(fault->raw_px.u - 959.5, fault->raw_px.v - 539.5), fault->radius_px, 1e-9);
  EXPECT_NEAR(fault->angle_deg, std::atan(1.0 / std::sqrt(3.6)) * 180.0 / std::acos(-1.0), 0.1);
}

TEST(LensFault, ForgivesAFoldBeyondTheCorners) {
  // Folds at 738 px for f = 2100: beyond the corner of 1280 x 720 only.
  EXPECT_FALSE(lens_fault({2100.0, 2100.0, 639.5, 359.5, {-1.2}}, 1280, 720));
  EXPECT_TRUE(lens_fault({2100.0, 2100.0, 639.5, 359.5, {-1.2}}, 1400, 720));
}

TEST(LensFault, FindsFoldsOfEveryModel) {
  EXPECT_TRUE(lens_fault(fisheye({-0.3}), 1920, 1080));
  EXPECT_FALSE(lens_fault(fisheye({-0.05}), 1920, 1080));
  EXPECT_TRUE(lens_fault(camera({0.0, 0.0, 0.5, 0.5}), 1920, 1080));  // tangential
  EXPECT_TRUE(lens_fault(camera({0.0, 0.0, 0.0, 0.0, 0.0, 10.0, 0.0, 0.0}), 1920, 1080));
  EXPECT_FALSE(lens_fault(camera({}), 1920, 1080));
  EXPECT_FALSE(lens_fault(CameraModel{}, 1920, 1080));
}

TEST(LensFault, IsFoundInACornerThatLiesFartherFromTheAxis) {
  const CameraModel model{2100.0, 2100.0, 300.0, 300.0, {-1.2}};
  const auto fault = lens_fault(model, 1280, 720);
  ASSERT_TRUE(fault);
  EXPECT_GT(fault->raw_px.u, 900.0);
}

}  // namespace
}  // namespace core

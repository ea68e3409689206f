#include "core/geometry/camera_model.h"

#include <gtest/gtest.h>

#include <cmath>

namespace core {
namespace {

CameraModel camera(std::array<double, 5> distortion) { return {2100.0, 2080.0, 961.5, 542.0, distortion}; }

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

TEST(CameraModel, UndistortUndoesDistort) {
  const std::array<double, 5> lenses[] = {{0.0, 0.0, 0.0, 0.0, 0.0},
                                          {-0.35, 0.12, 0.001, -0.002, 0.0},
                                          {0.2, -0.1, -0.001, 0.002, 0.05},
                                          {-0.4, 0.2, 0.0, 0.0, -0.05}};
  for (const auto& lens : lenses) {
    const CameraModel model = camera(lens);
    for (double u = 0.0; u <= 1920.0; u += 240.0) {
      for (double v = 0.0; v <= 1080.0; v += 180.0) {
        const Vector2 back = model.undistort(model.distort({u, v}));
        EXPECT_NEAR(back.u, u, 1e-6) << lens[0] << " at " << u << ", " << v;
        EXPECT_NEAR(back.v, v, 1e-6) << lens[0] << " at " << u << ", " << v;
      }
    }
  }
}

}  // namespace
}  // namespace core

#include "core/simulation/camera/projection.h"

#include <gtest/gtest.h>

namespace core::simulation {
namespace {

TEST(Projection, PutsThePrincipalRayAtThePrincipalPoint) {
  const ImagePoint image = project({}, {}, 0.0, 0.0, 2000.0);
  EXPECT_DOUBLE_EQ(image.u_px, 959.5);
  EXPECT_DOUBLE_EQ(image.v_px, 539.5);
}

TEST(Projection, IsUndoneByBackProjectionForATurnedCamera) {
  const CameraPose pose{30.0, -12.0, 45.0, attitude(0.02, -0.05, 0.03)};
  const ImagePoint image = project({}, pose, 140.0, -410.0, 2000.0);
  const PlanePoint point = back_project({}, pose, image, 2000.0);
  EXPECT_NEAR(point.x_mm, 140.0, 1e-9);
  EXPECT_NEAR(point.y_mm, -410.0, 1e-9);
}

// The linear field of a small camera motion (t, w) on a static point at x, y (in focal lengths), depth Z.
TEST(Projection, AgreesWithTheLinearFieldOfASmallMotion) {
  const CameraParameters camera;
  const double z = 2000.0, x = 0.2, y = -0.15, tx = 0.3, ty = -0.2, tz = 0.4, wx = 1e-4, wy = -2e-4, wz = 1.5e-4;
  const ImagePoint before = project(camera, {}, x * z, y * z, z);
  const ImagePoint after = project(camera, {tx, ty, tz, attitude(wx, wy, wz)}, x * z, y * z, z);
  const double dx = -tx / z + x * tz / z + x * y * wx - (1 + x * x) * wy + y * wz;
  const double dy = -ty / z + y * tz / z + (1 + y * y) * wx - x * y * wy - x * wz;
  EXPECT_NEAR((after.u_px - before.u_px) / camera.alpha_px, dx, 1e-7);
  EXPECT_NEAR((after.v_px - before.v_px) / camera.alpha_px, dy, 1e-7);
}

}  // namespace
}  // namespace core::simulation

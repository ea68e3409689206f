#include "firmware_app/chain/observation.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace app {
namespace {

core::TrackFrame points_of(const std::vector<int>& per_region) {
  core::TrackFrame frame;
  for (std::size_t r = 0; r < per_region.size(); ++r) {
    core::TrackPoint point;
    point.region = static_cast<std::uint16_t>(r);
    frame.points.insert(frame.points.end(), static_cast<std::size_t>(per_region[r]), point);
  }
  return frame;
}

TEST(ObservedPoints, AreSoManyOfEachRegionEvenlyOverItsPoints) {
  const ObservedPoints points = observed_points(points_of({30, 5, 13}), 3, 12);
  ASSERT_EQ(points.column_of_point.size(), 48U);
  EXPECT_EQ(std::count(points.region_of_column.begin(), points.region_of_column.end(), 0U), 12);
  EXPECT_EQ(std::count(points.region_of_column.begin(), points.region_of_column.end(), 1U), 5);
  EXPECT_EQ(std::count(points.region_of_column.begin(), points.region_of_column.end(), 2U), 12);
  int next = 0, gap = 0;
  for (std::size_t i = 0; i < points.column_of_point.size(); ++i) {
    gap = points.column_of_point[i] < 0 ? gap + 1 : 0;
    EXPECT_LE(gap, 2) << i;  // of thirty, two or three apart
    if (points.column_of_point[i] < 0) continue;
    EXPECT_EQ(points.column_of_point[i], next++) << i;
  }
}

TEST(DeclaredObservation, TakesTheConfigurationsWordBeforeTheCameras) {
  core::CameraInfo camera;
  camera.width_px = 800, camera.height_px = 600, camera.rate_hz = 25.0, camera.readout_ns = 20'000'000;
  AppConfig config;
  DeclaredObservation declared = declared_observation(config, camera);
  EXPECT_DOUBLE_EQ(declared.record.readout_frames, 0.5);
  EXPECT_DOUBLE_EQ(declared.record.alpha_px, 800.0);
  ASSERT_EQ(declared.warnings.size(), 1U);
  EXPECT_NE(declared.warnings[0].find("no calibration"), std::string::npos);
  config.camera.rate_hz = 50.0, config.camera.readout_ms = 10.0;
  config.calibration.fx = 900.0, config.calibration.fy = 905.0, config.calibration.cx = 390.0;
  declared = declared_observation(config, camera);
  EXPECT_DOUBLE_EQ(declared.record.rate_hz, 50.0);
  EXPECT_DOUBLE_EQ(declared.record.readout_frames, 0.5);
  EXPECT_DOUBLE_EQ(declared.record.alpha_px, 900.0);
  EXPECT_DOUBLE_EQ(declared.record.cx_px, 390.0);
  EXPECT_TRUE(declared.warnings.empty());
}

}  // namespace
}  // namespace app

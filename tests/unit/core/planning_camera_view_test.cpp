#include "core/planning/camera_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace core::planning {
namespace {

TEST(CameraView, FocalLengthFromDataSheets) {
  EXPECT_NEAR(focal_px_from_mm(24.0, 13.2, 3840), 6981.8, 0.1);
  EXPECT_NEAR(focal_px_from_fov(90.0, 2000), 1000.0, 1e-9);
  EXPECT_THROW((void)focal_px_from_mm(24.0, 0.0, 3840), std::invalid_argument);
  EXPECT_THROW((void)focal_px_from_fov(180.0, 3840), std::invalid_argument);
  EXPECT_THROW((void)focal_px_from_fov(std::numeric_limits<double>::quiet_NaN(), 3840), std::invalid_argument);
}

TEST(CameraView, ScaleIsDistanceOverFocalLength) {
  EXPECT_NEAR(mm_per_px({}, 2000.0), 0.952381, 1e-6);  // 2 m, 2100 px
}

TEST(CameraView, RowDelaysByHand) {
  // 840 mm in 882 px about row 540 of 1080, 26 ms: the foot is read at (540 + 441) / 1080 of it, the top at 99 / 1080.
  const auto delays = row_delays_s({}, LongAxis::kVertical, 2000.0, 840.0, {0.0, 0.5, 1.0});
  EXPECT_NEAR(delays[0], 0.026 * 981.0 / 1080.0, 1e-12);
  EXPECT_NEAR(delays[1], 0.013, 1e-12);
  EXPECT_NEAR(delays[2], 0.026 * 99.0 / 1080.0, 1e-12);
}

TEST(CameraView, ReadingUpwardsTurnsTheOrderRound) {
  PlannedCamera up;
  up.direction = ReadoutDirection::kUp;
  PlannedCamera negative;
  negative.readout_s = -0.026;
  for (const PlannedCamera& camera : {up, negative}) {
    const auto delays = row_delays_s(camera, LongAxis::kVertical, 2000.0, 840.0, {0.0, 1.0});
    EXPECT_NEAR(delays[1] - delays[0], 0.026 * 882.0 / 1080.0, 1e-12);
  }
}

TEST(CameraView, ReadingAcrossTheStructureGivesOneDelayToAll) {
  const auto delays = row_delays_s({}, LongAxis::kHorizontal, 2000.0, 840.0, {0.1, 0.5, 0.9});
  EXPECT_DOUBLE_EQ(delays[0], delays[1]);
  EXPECT_DOUBLE_EQ(delays[0], delays[2]);
  EXPECT_FALSE(reads_along({}, LongAxis::kHorizontal));
}

TEST(CameraView, TurningTheCameraTurnsPictureAndReadout) {
  const PlannedCamera once = turned({});
  EXPECT_EQ(once.width_px, 1080);
  EXPECT_EQ(once.height_px, 1920);
  EXPECT_TRUE(reads_along(once, LongAxis::kHorizontal));
  const auto delays = row_delays_s(once, LongAxis::kHorizontal, 2000.0, 840.0, {0.0, 1.0});
  EXPECT_NEAR(std::abs(delays[1] - delays[0]), 0.026 * 882.0 / 1080.0, 1e-12);
  const PlannedCamera four = turned(turned(turned(once)));
  EXPECT_EQ(four.direction, ReadoutDirection::kDown);
  EXPECT_EQ(four.width_px, 1920);
}

TEST(CameraView, RefusesImpossibleCameras) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refuses = [](auto change) {
    PlannedCamera camera;
    change(camera);
    EXPECT_THROW(validate(camera), std::invalid_argument);
  };
  refuses([](PlannedCamera& c) { c.rate_hz = 0.0; });
  refuses([](PlannedCamera& c) { c.rate_hz = -25.0; });
  refuses([&](PlannedCamera& c) { c.rate_hz = nan; });
  refuses([](PlannedCamera& c) { c.focal_px = 0.0; });
  refuses([](PlannedCamera& c) { c.readout_s = 0.041; });  // longer than a frame
  refuses([](PlannedCamera& c) { c.readout_s = -0.041; });
  refuses([&](PlannedCamera& c) { c.readout_s = nan; });
  refuses([](PlannedCamera& c) { c.exposure_s = -0.001; });
  refuses([&](PlannedCamera& c) { c.exposure_s = nan; });
  refuses([](PlannedCamera& c) { c.width_px = 0; });
  EXPECT_NO_THROW(validate(PlannedCamera{}));
}

}  // namespace
}  // namespace core::planning

#include "drivers/camera/camera_factory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/support/camera_drain.h"
#include "tests/support/test_clip.h"

namespace drivers {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(CameraFactory, MakesAFileCameraWithItsOptions) {
  const auto clip = test_support::fresh_folder() / "clip.avi";
  test_support::write_clip(clip, {.n_frames = 6});
  const auto camera = make_camera({.kind = CameraKind::kFile,
                                   .source = clip.string(),
                                   .rate_hz = 120.0,
                                   .readout_ms = 12.5,
                                   .readout_direction = core::ReadoutDirection::kUp,
                                   .exposure_ms = 2.0});
  EXPECT_DOUBLE_EQ(camera->info().rate_hz, 120.0);
  EXPECT_EQ(camera->info().readout_ns, 12'500'000);
  EXPECT_EQ(camera->info().readout_direction, core::ReadoutDirection::kUp);
  EXPECT_EQ(camera->info().exposure_ns, 2'000'000);
  camera->start();
  EXPECT_EQ(test_support::drain(*camera).frames.size(), 6u);
}

TEST(CameraFactory, MakesASyntheticCameraWithItsOptions) {
  const auto camera = make_camera({.kind = CameraKind::kSynthetic,
                                   .rate_hz = 50.0,
                                   .realtime = true,
                                   .readout_ms = 10.0,
                                   .exposure_ms = 1.0,
                                   .synthetic_duration_s = 2.0,
                                   .synthetic_seed = 5});
  EXPECT_EQ(camera->info().frame_count, 100u);
  EXPECT_EQ(camera->info().readout_ns, 10'000'000);
  EXPECT_EQ(camera->info().exposure_ns, 1'000'000);
  EXPECT_FALSE(camera->info().lossless);
}

TEST(CameraFactory, RefusesSyntheticOptionsOutOfRange) {
  EXPECT_THROW((void)make_camera({.kind = CameraKind::kSynthetic, .readout_direction = core::ReadoutDirection::kLeft}),
               std::invalid_argument);
  EXPECT_THROW((void)make_camera({.kind = CameraKind::kSynthetic, .readout_ms = 1e9}), std::invalid_argument);
  EXPECT_THROW((void)make_camera({.kind = CameraKind::kSynthetic, .synthetic_duration_s = -1.0}),
               std::invalid_argument);
}

TEST(CameraFactory, ACameraThatLibcameraDoesNotSeeIsAMissingDevice) {
  try {
    (void)make_camera({.kind = CameraKind::kLibcamera, .source = "no such camera"});
    FAIL();
  } catch (const DeviceMissing& thrown) {
    EXPECT_THAT(thrown.what(), HasSubstr("libcamera"));
  }
}

TEST(CameraFactory, NodesThatAreNoCamerasAreToldApart) {
  EXPECT_THROW((void)make_camera({.kind = CameraKind::kV4l2, .source = "/dev/video-none"}), DeviceMissing);
  try {
    (void)make_camera({.kind = CameraKind::kV4l2, .source = "/dev/null"});
    FAIL();
  } catch (const DeviceMissing&) {
    FAIL() << "it is there";
  } catch (const std::runtime_error& thrown) {
    EXPECT_THAT(thrown.what(),
                AllOf(HasSubstr("/dev/null"), HasSubstr("does not capture video"), HasSubstr("inspect cameras")));
  }
}

TEST(CameraFactory, MissingSourceIsAMissingDevice) {
  EXPECT_THROW((void)make_camera({.source = "no_such_clip.mp4"}), DeviceMissing);
}

}  // namespace
}  // namespace drivers

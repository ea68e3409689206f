#include "drivers/camera/device/v4l2_modes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace drivers {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

V4l2Mode mode(std::uint32_t fourcc, int width_px, int height_px, double rate_hz) {
  return {fourcc, *layout_of(fourcc), width_px, height_px, rate_hz};
}

// A usual webcam: uncompressed frames are slow where they are large.
const std::vector<V4l2Mode> kWebcam = {
    mode(V4L2_PIX_FMT_YUYV, 640, 480, 30),   mode(V4L2_PIX_FMT_YUYV, 1280, 720, 10),
    mode(V4L2_PIX_FMT_YUYV, 1920, 1080, 5),  mode(V4L2_PIX_FMT_MJPEG, 640, 480, 60),
    mode(V4L2_PIX_FMT_MJPEG, 1280, 720, 60), mode(V4L2_PIX_FMT_MJPEG, 1920, 1080, 30),
    mode(V4L2_PIX_FMT_MJPEG, 3840, 2160, 30)};

std::string chosen(const std::vector<V4l2Mode>& modes, const WantedMode& wanted) {
  return mode_text(choose_mode(modes, wanted, "camera"));
}

TEST(V4l2Modes, TheLargestUsualImageThatIsFastEnough) {
  EXPECT_EQ(chosen(kWebcam, {}), "MJPG 1920 x 1080 at up to 30 Hz");
  EXPECT_EQ(chosen(kWebcam, {.rate_hz = 60}), "MJPG 1280 x 720 at up to 60 Hz");
  EXPECT_EQ(chosen(kWebcam, {.rate_hz = 5}), "YUYV 1920 x 1080 at up to 5 Hz") << "no loss where none is needed";
}

TEST(V4l2Modes, WhatIsAskedForIsKept) {
  EXPECT_EQ(chosen(kWebcam, {.width_px = 640, .height_px = 480}), "MJPG 640 x 480 at up to 60 Hz");
  EXPECT_EQ(chosen(kWebcam, {.width_px = 640, .height_px = 480, .rate_hz = 30}), "YUYV 640 x 480 at up to 30 Hz");
  EXPECT_EQ(chosen(kWebcam, {.width_px = 3840, .height_px = 2160}), "MJPG 3840 x 2160 at up to 30 Hz");
  EXPECT_EQ(chosen(kWebcam, {.format = "YUYV"}), "YUYV 640 x 480 at up to 30 Hz");
}

TEST(V4l2Modes, GrayIsCheapestAndANominalRateIsMetByItsNeighbour) {
  const std::vector<V4l2Mode> industrial = {mode(V4L2_PIX_FMT_Y16, 1280, 800, 60),
                                            mode(V4L2_PIX_FMT_GREY, 1280, 800, 60),
                                            mode(V4L2_PIX_FMT_UYVY, 1280, 800, 60)};
  EXPECT_EQ(chosen(industrial, {}), "GREY 1280 x 800 at up to 60 Hz");
  EXPECT_EQ(chosen({mode(V4L2_PIX_FMT_GREY, 640, 480, 59.94)}, {.rate_hz = 60}), "GREY 640 x 480 at up to 59.94 Hz");
}

TEST(V4l2Modes, ASlowCameraIsBetterThanNone) {
  EXPECT_EQ(chosen({mode(V4L2_PIX_FMT_GREY, 640, 480, 9), mode(V4L2_PIX_FMT_GREY, 320, 240, 15)}, {}),
            "GREY 320 x 240 at up to 15 Hz");
}

TEST(V4l2Modes, WhatItCannotDoIsRefusedWithWhatItCan) {
  for (const WantedMode& wanted :
       {WantedMode{.width_px = 800, .height_px = 600}, WantedMode{.rate_hz = 120}, WantedMode{.format = "NV12"}}) {
    try {
      (void)choose_mode(kWebcam, wanted, "/dev/video7");
      FAIL();
    } catch (const std::runtime_error& thrown) {
      EXPECT_THAT(thrown.what(), AllOf(HasSubstr("/dev/video7"), HasSubstr("YUYV 640 x 480 at up to 30 Hz"),
                                       HasSubstr("camera.size")));
    }
  }
}

TEST(V4l2Modes, ACameraIsTheSameUnderAnotherNumber) {
  const V4l2Identity camera{"uvcvideo", "Camera", "usb-1.2", "0001"};
  V4l2Identity other = camera;
  other.bus_info = "usb-1.4";
  EXPECT_TRUE(camera.is_same_camera(other)) << "another socket";
  other.serial = "0002";
  EXPECT_FALSE(camera.is_same_camera(other));
  const V4l2Identity nameless{"uvcvideo", "Camera", "usb-1.2", ""};
  V4l2Identity moved = nameless;
  EXPECT_TRUE(nameless.is_same_camera(moved));
  moved.bus_info = "usb-1.4";
  EXPECT_FALSE(nameless.is_same_camera(moved)) << "nothing else tells them apart";
}

}  // namespace
}  // namespace drivers

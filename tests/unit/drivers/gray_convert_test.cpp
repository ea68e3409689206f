#include "drivers/camera/recording/gray_convert.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace drivers {
namespace {

core::Frame slot_of(int width_px, int height_px) {
  core::Frame frame;
  frame.pixels.assign(static_cast<std::size_t>(width_px * height_px), 0);
  return frame;
}

TEST(GrayConvert, CopiesGrayUnchangedIntoTheSlotThatIsThere) {
  cv::Mat image(3, 5, CV_8UC1);
  cv::randu(image, 0, 256);
  core::Frame frame = slot_of(5, 3);
  const std::uint8_t* const slot = frame.pixels.data();
  ASSERT_EQ(convert_to_gray(image, frame), GrayStatus::kOk);
  EXPECT_EQ(frame.pixels.data(), slot);
  EXPECT_EQ(frame.width_px, 5);
  EXPECT_EQ(frame.height_px, 3);
  EXPECT_TRUE(std::equal(frame.pixels.begin(), frame.pixels.end(), image.datastart));
}

TEST(GrayConvert, CopiesAnImageWhoseRowsArePadded) {
  cv::Mat whole(40, 40, CV_8UC1);
  cv::randu(whole, 0, 256);
  const cv::Mat part = whole(cv::Rect(3, 5, 7, 9));
  core::Frame frame = slot_of(7, 9);
  ASSERT_EQ(convert_to_gray(part, frame), GrayStatus::kOk);
  for (int v = 0; v < 9; ++v) {
    for (int u = 0; u < 7; ++u)
      EXPECT_EQ(frame.pixels[static_cast<std::size_t>(v * 7 + u)], part.at<std::uint8_t>(v, u));
  }
}

TEST(GrayConvert, WeighsColoursByLuma) {
  core::Frame frame = slot_of(33, 35);
  const std::uint8_t* const slot = frame.pixels.data();
  ASSERT_EQ(convert_to_gray(cv::Mat(35, 33, CV_8UC3, cv::Scalar(10, 100, 200)), frame), GrayStatus::kOk);
  EXPECT_EQ(frame.pixels.data(), slot);
  for (const std::uint8_t pixel : frame.pixels) ASSERT_NEAR(pixel, 0.114 * 10 + 0.587 * 100 + 0.299 * 200, 1.0);
  ASSERT_EQ(convert_to_gray(cv::Mat(35, 33, CV_8UC4, cv::Scalar(200, 100, 10, 0)), frame), GrayStatus::kOk);
  for (const std::uint8_t pixel : frame.pixels) ASSERT_NEAR(pixel, 0.114 * 200 + 0.587 * 100 + 0.299 * 10, 1.0);
}

TEST(GrayConvert, RefusesWhatIsNot8BitGrayOrColour) {
  core::Frame frame = slot_of(4, 4);
  EXPECT_EQ(convert_to_gray(cv::Mat(), frame), GrayStatus::kEmpty);
  for (const int type : {CV_8SC1, CV_16UC1, CV_16UC3, CV_32FC1, CV_64FC3}) {
    EXPECT_EQ(convert_to_gray(cv::Mat(4, 4, type, cv::Scalar::all(0)), frame), GrayStatus::kNot8Bit) << type;
  }
  EXPECT_EQ(convert_to_gray(cv::Mat(4, 4, CV_8UC2, cv::Scalar::all(0)), frame), GrayStatus::kChannelCount);
}

TEST(GrayConvert, RefusesASlotOfAnotherSizeAndLeavesItAlone) {
  core::Frame frame = slot_of(4, 4);
  EXPECT_EQ(convert_to_gray(cv::Mat(4, 5, CV_8UC1, cv::Scalar(9)), frame), GrayStatus::kSizeMismatch);
  EXPECT_EQ(frame.pixels, std::vector<std::uint8_t>(16, 0));
}

}  // namespace
}  // namespace drivers

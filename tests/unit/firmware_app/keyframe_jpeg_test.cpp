#include "firmware_app/chain/state/keyframe_jpeg.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace app {
namespace {

core::Frame ramp(int width_px, int height_px) {
  core::Frame frame;
  frame.width_px = width_px, frame.height_px = height_px;
  for (int i = 0; i < width_px * height_px; ++i)
    frame.pixels.push_back(static_cast<std::uint8_t>((i % width_px) * 255 / width_px));
  return frame;
}

core::CameraInfo camera(int width_px, int height_px) {
  core::CameraInfo info;
  info.width_px = width_px, info.height_px = height_px;
  return info;
}

TEST(KeyframeJpeg, IsReadAgainCloseToWhatItWas) {
  const core::Frame frame = ramp(97, 41);
  const auto again = keyframe_of(keyframe_jpeg(frame), camera(97, 41));
  ASSERT_TRUE(again);
  ASSERT_EQ(again->pixels.size(), frame.pixels.size());
  for (std::size_t i = 0; i < frame.pixels.size(); ++i)
    ASSERT_LE(std::abs(int{again->pixels[i]} - int{frame.pixels[i]}), 12) << i;
}

TEST(KeyframeJpeg, WhatIsNoneOfTheCameraIsLeftOut) {
  const std::string jpeg = keyframe_jpeg(ramp(97, 41));
  EXPECT_FALSE(keyframe_of(jpeg, camera(41, 97)));
  EXPECT_FALSE(keyframe_of(jpeg.substr(0, jpeg.size() / 2), camera(97, 41)));
  EXPECT_FALSE(keyframe_of("no JPEG", camera(97, 41)));
  EXPECT_FALSE(keyframe_of(jpeg, camera(2'000'000'000, 2'000'000'000)));
  EXPECT_TRUE(keyframe_jpeg({}).empty());
}

}  // namespace
}  // namespace app

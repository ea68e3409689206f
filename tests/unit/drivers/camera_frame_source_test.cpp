#include "drivers/camera/recording/frame_source.h"

#include <gtest/gtest.h>

#include "drivers/camera/recording/image_folder_source.h"

namespace drivers {
namespace {

TEST(FrameSource, SortsNumbersInNamesByValue) {
  EXPECT_TRUE(natural_less("f9.png", "f10.png"));
  EXPECT_FALSE(natural_less("f10.png", "f9.png"));
  EXPECT_TRUE(natural_less("f009.png", "f10.png"));
  EXPECT_TRUE(natural_less("a2b10", "a2b11"));
  EXPECT_TRUE(natural_less("a", "a1"));
  EXPECT_TRUE(natural_less("f99999999999999999999998", "f99999999999999999999999"));
  EXPECT_FALSE(natural_less("f1", "f1"));
  EXPECT_NE(natural_less("f01", "f1"), natural_less("f1", "f01"));
}

TEST(FrameSource, TurnsEveryReadoutDirection) {
  using enum core::ReadoutDirection;
  EXPECT_EQ(turn_clockwise(kDown, 90), kLeft);
  EXPECT_EQ(turn_clockwise(kLeft, 90), kUp);
  EXPECT_EQ(turn_clockwise(kUp, 90), kRight);
  EXPECT_EQ(turn_clockwise(kRight, 90), kDown);
  for (const auto direction : {kDown, kLeft, kUp, kRight}) {
    EXPECT_EQ(turn_clockwise(direction, 0), direction);
    EXPECT_EQ(turn_clockwise(turn_clockwise(direction, 180), 180), direction);
    EXPECT_EQ(turn_clockwise(direction, -90), turn_clockwise(direction, 270));
  }
}

}  // namespace
}  // namespace drivers

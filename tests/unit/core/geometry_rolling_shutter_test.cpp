#include "core/geometry/rolling_shutter.h"

#include <gtest/gtest.h>

namespace core {
namespace {

ReadoutModel model(ReadoutDirection direction) { return {0.020, direction, 640, 480}; }

TEST(ReadoutModel, DownReadsLaterRowsLater) {
  EXPECT_DOUBLE_EQ(model(ReadoutDirection::kDown).delay_s(600.0, 0.0), 0.0);
  EXPECT_DOUBLE_EQ(model(ReadoutDirection::kDown).delay_s(600.0, 240.0), 0.010);
}

TEST(ReadoutModel, UpReadsLaterRowsEarlier) {
  EXPECT_DOUBLE_EQ(model(ReadoutDirection::kUp).delay_s(600.0, 240.0), -0.010);
}

TEST(ReadoutModel, RightAndLeftRunAlongColumns) {
  EXPECT_DOUBLE_EQ(model(ReadoutDirection::kRight).delay_s(160.0, 400.0), 0.005);
  EXPECT_DOUBLE_EQ(model(ReadoutDirection::kLeft).delay_s(160.0, 400.0), -0.005);
}

TEST(ReadoutModel, ASignedReadoutTurnsTheDirection) {
  ReadoutModel negative = model(ReadoutDirection::kDown);
  negative.readout_s = -0.020;
  EXPECT_DOUBLE_EQ(negative.delay_s(0.0, 240.0), model(ReadoutDirection::kUp).delay_s(0.0, 240.0));
}

TEST(ReadoutModel, AGlobalShutterHasNoDelay) {
  ReadoutModel global = model(ReadoutDirection::kDown);
  global.readout_s = 0.0;
  EXPECT_EQ(global.delay_s(100.0, 479.0), 0.0);
}

}  // namespace
}  // namespace core

#include "core/planning/hover_time.h"

#include <gtest/gtest.h>

namespace core::planning {
namespace {

TEST(HoverTime, SigmasByHand) {
  // f = 2 Hz, zeta = 1 %, T = 100 s: 2 pi f T = 1256.637
  EXPECT_NEAR(relative_frequency_sigma(2.0, 0.01, 100.0), 1.2 * 2.82095e-3, 1e-7);
  EXPECT_NEAR(relative_damping_sigma(2.0, 0.01, 100.0), 1.2 * 0.282095, 1e-5);
}

TEST(HoverTime, SecondsByHand) {
  // 1.44 * 0.01 / (2 pi * 1.657 * 0.003^2) = 153.68 s; 1.44 / (2 pi * 0.01657 * 0.04) = 345.78 s
  EXPECT_NEAR(seconds_for_frequency(1.657, 0.01, 0.003), 153.68, 0.01);
  EXPECT_NEAR(seconds_for_damping(1.657, 0.01, 0.2), 345.78, 0.01);
}

TEST(HoverTime, SecondsAndSigmasUndoOneAnother) {
  for (const double f : {0.2, 1.657, 14.34}) {
    EXPECT_NEAR(relative_frequency_sigma(f, 0.02, seconds_for_frequency(f, 0.02, 0.004)), 0.004, 1e-12);
    EXPECT_NEAR(relative_damping_sigma(f, 0.02, seconds_for_damping(f, 0.02, 0.15)), 0.15, 1e-12);
  }
}

TEST(HoverTime, SegmentHoldsTwoTimeConstantsAndTheRecordFourSegments) {
  // 2 / (0.01 * 2 pi * 1.657) = 19.2 s = 480 frames at 25 fps
  EXPECT_EQ(segment_length(1.657, 0.01, 25.0, 600.0), 512);
  EXPECT_EQ(segment_length(1.657, 0.01, 25.0, 60.0), 256);   // 1500 frames hold four of 375 at most
  EXPECT_EQ(segment_length(0.1, 0.001, 25.0, 600.0), 2048);  // never more than the record allows
  EXPECT_EQ(segment_length(20.0, 0.1, 25.0, 600.0), 64);
  EXPECT_NEAR(hann_bandwidth_hz(512, 25.0), 0.0732, 1e-4);
}

}  // namespace
}  // namespace core::planning

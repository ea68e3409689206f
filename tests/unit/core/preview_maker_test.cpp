#include "core/tracking/preview_maker.h"

#include <gtest/gtest.h>

namespace {

using core::Frame;
using core::Preview;
using core::PreviewMaker;
using core::TrackFrame;

Frame frame_of(int width, int height, std::uint64_t sequence = 7) {
  Frame out;
  out.sequence = sequence, out.t_start_ns = static_cast<std::int64_t>(sequence) * 40'000'000;
  out.width_px = width, out.height_px = height;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) out.pixels.push_back(static_cast<std::uint8_t>((x * 7 + y * 13) % 256));
  }
  return out;
}

TrackFrame two_points() {
  TrackFrame out;
  out.points = {
      {10.0, 20.0, 0.1, 0, 0, true, true}, {30.0, 20.0, 0.1, 1, 0, true, true}, {5.0, 5.0, 0.1, 2, 1, true, true}};
  return out;
}

TEST(PreviewMaker, EveryPixelIsTheRoundedMeanOfItsBox) {
  const Frame frame = frame_of(1925, 1083);  // neither side is a whole number of boxes
  PreviewMaker maker({1.0, 320}, 1925, 1083, two_points(), 2);
  Preview out = maker.prototype();
  maker.make(frame, two_points(), out);
  ASSERT_EQ(out.reduction, 7);
  ASSERT_EQ(out.width_px, 275);
  ASSERT_EQ(out.height_px, 154);
  for (int y = 0; y < out.height_px; y += 11) {
    for (int x = 0; x < out.width_px; ++x) {
      double sum = 0.0;
      for (int v = 0; v < 7; ++v) {
        for (int u = 0; u < 7; ++u) sum += frame.pixels[static_cast<std::size_t>((y * 7 + v) * 1925 + x * 7 + u)];
      }
      EXPECT_EQ(out.pixels[static_cast<std::size_t>(y * out.width_px + x)], static_cast<int>(sum / 49.0 + 0.5))
          << x << " " << y;
    }
  }
  EXPECT_EQ(out.sequence, 7U);
}

TEST(PreviewMaker, AWhiteImageOfAnySizeIsWhite) {
  for (const int long_side : {1, 64, 320, 8192, 70000}) {
    Frame frame = frame_of(long_side, 3);
    frame.pixels.assign(frame.pixels.size(), 255);
    PreviewMaker maker({1.0, 64}, long_side, 3, two_points(), 1);
    Preview out = maker.prototype();
    maker.make(frame, two_points(), out);
    const bool is_flat = 3 < out.reduction;  // less than one box: unchanged
    EXPECT_EQ(out.pixels.front(), is_flat ? 0 : 255) << long_side;
    EXPECT_EQ(out.pixels.back(), out.pixels.front());
  }
}

TEST(PreviewMaker, IsDueOnceAPeriodOfStreamTimeAndNeverWhereItIsOff) {
  PreviewMaker maker({1.0, 320}, 640, 480, two_points(), 2);
  int n_due = 0;
  for (std::int64_t n = 0; n < 250; ++n) n_due += maker.is_due(n * 40'000'000) ? 1 : 0;  // 10 s at 25 frames a second
  EXPECT_EQ(n_due, 10);
  EXPECT_TRUE(maker.is_due(5)) << "a stream that began again";
  PreviewMaker off({0.0, 320}, 640, 480, two_points(), 2);
  EXPECT_FALSE(off.is_due(0));
}

TEST(PreviewMaker, RegionsMoveByTheMeanOfTheirInliers) {
  PreviewMaker maker({1.0, 320}, 640, 480, two_points(), 3);
  Preview out = maker.prototype();
  TrackFrame now = two_points();
  now.points[0].u_px += 2.0, now.points[1].u_px += 4.0, now.points[1].v_px += 1.0;
  now.points[2].inlier = false, now.points[2].u_px += 100.0;
  maker.make(frame_of(640, 480), now, out);
  EXPECT_DOUBLE_EQ(out.shifts[0].u_px, 3.0);
  EXPECT_DOUBLE_EQ(out.shifts[0].v_px, 0.5);
  EXPECT_EQ(out.shifts[0].n_points, 2U);
  EXPECT_EQ(out.shifts[1].n_points, 0U);
  EXPECT_DOUBLE_EQ(out.shifts[1].u_px, 0.0);
}

TEST(PreviewMaker, AFrameOfAnotherSizeLeavesThePictureAsItIs) {
  PreviewMaker maker({1.0, 320}, 640, 480, two_points(), 2);
  Preview out = maker.prototype();
  maker.make(frame_of(320, 240), two_points(), out);
  EXPECT_EQ(out.sequence, 0U);
}

}  // namespace

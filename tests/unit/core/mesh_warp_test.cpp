#include "core/geometry/mesh_warp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace core {
namespace {

// A smooth texture: wavelengths of 11 to 19 px.
double brightness(double u, double v) {
  return 128.0 + 50.0 * std::sin(u * 2.0 * std::numbers::pi / 19.0) * std::cos(v * 2.0 * std::numbers::pi / 13.0) +
         30.0 * std::sin((u + v) * 2.0 * std::numbers::pi / 11.0);
}

cv::Mat textured(int width, int height) {
  cv::Mat out(height, width, CV_8UC1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) out.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(brightness(x, y));
  }
  return out;
}

const WarpPart kRoof{60, 20, 140, 44, 6.0, {0.0, -2.0}}, kBase{60, 130, 140, 150, 0.0, 0.0};

TEST(MeshWarp, APartMovesAsAWholeAndTheRestHoldsItsPlace) {
  const MeshWarp warp(200, 160, {kRoof, kBase});
  EXPECT_LT(warp.strain(), MeshWarp::kMostStrain);
  for (const double phase : {0.0, std::numbers::pi / 2.0, 2.0}) {
    const Vector2 roof = warp.shift({100.0, 30.0}, phase), base = warp.shift({100.0, 140.0}, phase);
    EXPECT_DOUBLE_EQ(roof.u, 6.0 * std::cos(phase));
    EXPECT_DOUBLE_EQ(roof.v, 2.0 * std::sin(phase));  // a quarter of a period behind
    EXPECT_EQ(base.u, 0.0);
    EXPECT_EQ(base.v, 0.0);
  }
  const double between = warp.shift({100.0, 87.0}, 0.0).u, far = warp.shift({199.0, 159.0}, 0.0).u;
  EXPECT_GT(between, 0.5);
  EXPECT_LT(between, 4.0);
  EXPECT_LT(std::abs(far), 0.5);
}

TEST(MeshWarp, DrawsThePartsWhereTheyAreShifted) {
  const MeshWarp warp(200, 160, {kRoof, kBase});
  const cv::Mat image = textured(200, 160);
  for (const double phase : {0.0, 0.7, 2.5}) {
    const cv::Mat drawn = warp.draw(image, phase);
    const Vector2 by = warp.shift({100.0, 30.0}, phase);
    double squares = 0.0;
    int n = 0;
    for (int y = 26; y < 38; ++y) {
      for (int x = 72; x < 128; ++x, ++n)
        squares += std::pow(drawn.at<std::uint8_t>(y, x) - brightness(x - by.u, y - by.v), 2.0);
    }
    EXPECT_LT(std::sqrt(squares / n), 1.0) << phase;  // rounding to grey levels alone: 0.5
    EXPECT_EQ(drawn.at<std::uint8_t>(140, 100), image.at<std::uint8_t>(140, 100));
  }
}

TEST(MeshWarp, StatesTheStrainThatWouldFoldTheImage) {
  WarpPart near = kBase;
  near.top = 50, near.bottom = 70;
  WarpPart far = kRoof;
  far.swing_u = 30.0;
  EXPECT_GT(MeshWarp(200, 160, {far, near}).strain(), MeshWarp::kMostStrain);
  // The strain is proportional to the swing.
  WarpPart half = far;
  half.swing_u = 15.0, half.swing_v *= 0.5;
  EXPECT_NEAR(MeshWarp(200, 160, {half, near}).strain(), 0.5 * MeshWarp(200, 160, {far, near}).strain(), 1e-12);
}

TEST(MeshWarp, RefusesWhatIsNoPart) {
  EXPECT_THROW(MeshWarp(200, 160, {}), std::invalid_argument);
  EXPECT_THROW(MeshWarp(1, 160, {kRoof}), std::invalid_argument);
  EXPECT_THROW(MeshWarp(200, 160, {WarpPart{9, 9, 9, 20, 1.0, 0.0}}), std::invalid_argument);
  WarpPart bad = kRoof;
  bad.swing_v = {std::numeric_limits<double>::quiet_NaN(), 0.0};
  EXPECT_THROW(MeshWarp(200, 160, {bad}), std::invalid_argument);
}

}  // namespace
}  // namespace core

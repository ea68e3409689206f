#include "core/geometry/region_shear.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>

namespace core {
namespace {

constexpr int kWidth = 1000, kHeight = 800;
constexpr std::size_t kPoints = 24;  // per region

RegionShear::Config config_of(std::size_t n_regions) {
  RegionShear::Config config;
  config.n_regions = n_regions;
  config.readout.width_px = kWidth;
  config.readout.height_px = kHeight;
  return config;
}

// Points scattered unevenly over regions that stand side by side.
TrackFrame keyframe_of(std::size_t n_regions) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  TrackFrame frame;
  for (std::size_t r = 0; r < n_regions; ++r) {
    for (std::size_t i = 0; i < kPoints; ++i) {
      TrackPoint point;
      point.u_px = 100.0 + 300.0 * static_cast<double>(r) + 200.0 * unit(random);
      point.v_px = 150.0 + 100.0 * static_cast<double>(r) + 250.0 * unit(random) * unit(random);
      point.sigma_px = 1.0;
      point.region = static_cast<std::uint16_t>(r);
      point.seen = point.inlier = true;
      frame.points.push_back(point);
    }
  }
  return frame;
}

double fraction(const TrackPoint& point) { return point.v_px / kHeight; }

TrackFrame moved(TrackFrame frame, const std::function<Vector2(const TrackPoint&)>& motion) {
  for (TrackPoint& point : frame.points) {
    const Vector2 d = motion(point);
    point.u_px += d.u, point.v_px += d.v;
  }
  return frame;
}

RegionShear::Sample fitted(RegionShear& shear, const TrackFrame& frame) {
  RegionShear::Sample sample = shear.sample_prototype();
  shear.fit(frame, sample);
  return sample;
}

TEST(RegionShear, MeasuresShearAndMeanMotionOfEveryRegion) {
  const TrackFrame keyframe = keyframe_of(2);
  RegionShear shear(config_of(2), keyframe);
  ASSERT_EQ(shear.n_usable(), 2U);
  const RegionShear::Sample sample = fitted(
      shear, moved(keyframe, [](const TrackPoint& p) {
        return p.region == 0 ? Vector2{5.0 + 2.0 * fraction(p), -3.0 + fraction(p)} : Vector2{-1.0 * fraction(p), 4.0};
      }));
  double mean = 0.0;
  for (std::size_t j = 0; j < kPoints; ++j) mean += fraction(keyframe.points[j]) / static_cast<double>(kPoints);
  const std::vector<double> shears{2.0, 1.0, -1.0, 0.0};
  for (std::size_t i = 0; i < shears.size(); ++i) EXPECT_NEAR(sample.shear_px[i], shears[i], 1e-8) << i;
  EXPECT_NEAR(sample.carrier_px[0], 5.0 + 2.0 * mean, 1e-8);
  EXPECT_NEAR(sample.carrier_px[1], -3.0 + mean, 1e-8);
  EXPECT_NEAR(sample.carrier_px[3], 4.0, 1e-8);
  EXPECT_EQ(sample.seen, (std::vector<std::uint8_t>{1, 1}));
}

TEST(RegionShear, ATurningOrGrowingRegionHasNoShear) {
  const TrackFrame keyframe = keyframe_of(2);
  RegionShear shear(config_of(2), keyframe);
  const RegionShear::Sample sample = fitted(shear, moved(keyframe, [](const TrackPoint& p) {
                                              const double x = p.u_px - 300.0, y = p.v_px - 200.0;
                                              const double turn = p.region == 0 ? 0.01 : -0.02;
                                              return Vector2{turn * y + 0.03 * x, -turn * x + 0.03 * y};
                                            }));
  for (const double value : sample.shear_px) EXPECT_NEAR(value, 0.0, 1e-8);
}

// The camera's pitch: (x y, y^2) over the width. Its linear part along v, 2 y per row of a region at y, is up to 8 px
// over the readout; the prior of pitch keeps less than a hundredth of it.
TEST(RegionShear, TheCamerasPitchIsNoShear) {
  const TrackFrame keyframe = keyframe_of(3);
  RegionShear shear(config_of(3), keyframe);
  const RegionShear::Sample sample = fitted(shear, moved(keyframe, [](const TrackPoint& p) {
                                              const double x = p.u_px - 0.5 * (kWidth - 1);
                                              const double y = p.v_px - 0.5 * (kHeight - 1);
                                              return Vector2{0.02 * x * y / kWidth, 0.02 * y * y / kWidth};
                                            }));
  for (const double value : sample.shear_px) EXPECT_NEAR(value, 0.0, 0.08);
}

TEST(RegionShear, IsThatOfTheRegionAsLargeAsInTheKeyframe) {
  const TrackFrame keyframe = keyframe_of(1);
  RegionShear shear(config_of(1), keyframe);
  const RegionShear::Sample sample = fitted(shear, moved(keyframe, [](const TrackPoint& p) {
                                              return Vector2{0.1 * p.u_px + 2.2 * fraction(p), 0.1 * p.v_px};
                                            }));
  EXPECT_NEAR(sample.shear_px[0], 2.0, 1e-8);
}

// A region that drifts and turns steadily, each point seen rho times its fraction later: also where the points are
// spread unevenly, the shear is rho times the carrier's rate.
TEST(RegionShear, IsTheReadoutTimesTheCarriersRate) {
  constexpr double kRho = 0.8, kTurnRate = 2e-4;  // frames; rad per frame
  const TrackFrame keyframe = keyframe_of(1);
  RegionShear shear(config_of(1), keyframe);
  const auto at = [&](double frame) {
    return fitted(shear, moved(keyframe, [&](const TrackPoint& p) {
                    const double t = frame + kRho * fraction(p), x = p.u_px - 200.0, y = p.v_px - 250.0;
                    return Vector2{t * (0.5 + kTurnRate * y), t * (0.2 - kTurnRate * x)};
                  }));
  };
  const RegionShear::Sample before = at(2.0), after = at(3.0);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double rate = after.carrier_px[axis] - before.carrier_px[axis];
    EXPECT_NEAR(before.shear_px[axis], kRho * rate, 1e-4 * std::abs(rate)) << axis;
  }
}

TEST(RegionShear, InformationIsTheScatterUnderNoise) {
  const TrackFrame keyframe = keyframe_of(2);
  RegionShear shear(config_of(2), keyframe);
  const Eigen::MatrixXd expected = shear.information().inverse();
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0.0, 0.1);
  constexpr int kFrames = 4000;
  Eigen::Vector4d shears = Eigen::Vector4d::Zero(), carriers = shears;
  for (int k = 0; k < kFrames; ++k) {
    const RegionShear::Sample sample = fitted(shear, moved(keyframe, [&](const TrackPoint&) {
                                                return Vector2{noise(random), noise(random)};
                                              }));
    for (std::size_t i = 0; i < 4; ++i) {
      shears(static_cast<int>(i)) += 100.0 * sample.shear_px[i] * sample.shear_px[i] / kFrames;
      carriers(static_cast<int>(i)) += 100.0 * sample.carrier_px[i] * sample.carrier_px[i] / kFrames;
    }
  }
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(shears(i) / expected(i, i), 1.0, 0.1) << i;  // 4.5 sigma of 4000 frames
    EXPECT_NEAR(carriers(i) / shear.carrier_covariance()(i, i), 1.0, 0.1) << i;
  }
}

TEST(RegionShear, LostPointsAndOutliersTakeNoPart) {
  const TrackFrame keyframe = keyframe_of(1);
  RegionShear shear(config_of(1), keyframe);
  TrackFrame frame = moved(keyframe, [](const TrackPoint& p) { return Vector2{2.0 * fraction(p), 0.0}; });
  frame.points[0].u_px += 50.0, frame.points[0].inlier = false;
  frame.points[1].v_px += 50.0, frame.points[1].seen = false;
  frame.points[2].u_px = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NEAR(fitted(shear, frame).shear_px[0], 2.0, 1e-8);
  for (std::size_t j = 3; j < kPoints; ++j) frame.points[j].seen = false;
  EXPECT_EQ(fitted(shear, frame).seen[0], 0);
}

TEST(RegionShear, ARegionOfOneRowIsNotUsable) {
  TrackFrame keyframe = keyframe_of(2);
  for (TrackPoint& point : keyframe.points) {
    if (point.region == 1) point.v_px = 400.0;
  }
  RegionShear shear(config_of(2), keyframe);
  EXPECT_EQ(shear.n_usable(), 1U);
  EXPECT_EQ(shear.information()(2, 2), 0.0);
  EXPECT_GT(shear.information()(0, 0), 0.0);
  EXPECT_EQ(fitted(shear, keyframe).seen, (std::vector<std::uint8_t>{1, 0}));
}

TEST(RegionShear, RefusesAPointOfNoRegion) {
  EXPECT_THROW(RegionShear(config_of(1), keyframe_of(2)), std::invalid_argument);
}

}  // namespace
}  // namespace core

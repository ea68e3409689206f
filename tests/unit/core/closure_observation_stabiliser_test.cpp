#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "core/closure/closure_loop.h"
#include "core/closure/noise_stream.h"
#include "core/closure/observation/observation_level.h"
#include "core/types/constants.h"

namespace core::closure {
namespace {

// Motion of the camera in gusts: many sines whose amplitude falls with the square of the frequency, 5 mm rms.
class Gusts {
 public:
  explicit Gusts(std::uint64_t seed) {
    NoiseStream noise(seed);
    double squares = 0.0;
    for (int i = 0; i < 34; ++i) {
      const double hz = 0.07 * std::pow(1.13, i);
      lines_.push_back({hz, std::polar(1.0 / (0.02 + hz * hz), kTwoPi * noise.gaussian())});
      squares += 0.5 * std::norm(lines_.back().value);
    }
    for (Line& line : lines_) line.value *= 5.0 / std::sqrt(squares);
  }
  [[nodiscard]] double at(double t_s) const { return followed(t_s, 0.0, 0.0); }
  // Above a corner frequency, later by a lag.
  [[nodiscard]] double followed(double t_s, double corner_hz, double lag_s) const {
    std::complex<double> sum = 0.0;
    for (const Line& line : lines_) {
      sum += line.value * std::complex<double>(0.0, line.hz) / std::complex<double>(corner_hz, line.hz) *
             std::polar(1.0, kTwoPi * line.hz * (t_s - lag_s));
    }
    return sum.real();
  }

 private:
  struct Line {
    double hz;
    std::complex<double> value;
  };
  std::vector<Line> lines_;
};

constexpr double kCorner_hz = 0.6, kLag_s = 0.05;

struct Camera {
  double stabiliser = 0.0;  // gain: every frame is shifted as a whole
  double gimbal = 0.0;      // the same, but by turns of the camera
  double readout_frames = 0.0;
};

// A base and four storeys at 2 m that sway along u, a background at 4 m, ten points each; noise of 0.03 px.
ObservationRecord gusty_record(const Camera& camera) {
  constexpr Eigen::Index kFrames = 2400, kRegions = 6;
  constexpr double kNoise_px = 0.03, kNear_mm = 2000.0, kFar_mm = 4000.0;
  ObservationRecord r;
  r.rate_hz = 30.0, r.alpha_px = 1800.0, r.cx_px = 960.0, r.cy_px = 540.0, r.width_px = 1920, r.height_px = 1080;
  r.readout_frames = camera.readout_frames;
  for (Eigen::Index i = 0; i < kRegions; ++i) {
    Region region;
    region.name = "region" + std::to_string(i);
    region.role = i == kRegions - 1 ? RegionRole::kBackground : i == 0 ? RegionRole::kBase : RegionRole::kStructure;
    r.regions.push_back(region);
  }
  const Gusts along(1), across(2), ahead(3);
  r.u_px.resize(kFrames, 10 * kRegions), r.v_px.resize(kFrames, 10 * kRegions);
  NoiseStream noise(5);
  for (Eigen::Index j = 0; j < 10 * kRegions; ++j) {
    const auto region = static_cast<int>(j / 10), i = static_cast<int>(j % 10);
    r.region_of_point.push_back(static_cast<std::size_t>(region));
    r.sigma_px.push_back(kNoise_px);
    const bool behind = region == kRegions - 1;
    const double depth_mm = behind ? kFar_mm : kNear_mm;
    const double x_mm = (behind ? 180.0 : 60.0) * (static_cast<double>((7 * i) % 10) - 4.5);
    const double y_mm = behind ? 190.0 * (i - 4.5) : 420.0 - 210.0 * region + 11.0 * (i - 4.5);
    const double share = 0.5 + r.alpha_px * y_mm / depth_mm / r.height_px;
    for (Eigen::Index k = 0; k < kFrames; ++k) {
      const double middle_s = (static_cast<double>(k) + 0.5 * r.readout_frames) / r.rate_hz;
      const double t = (static_cast<double>(k) + r.readout_frames * share) / r.rate_hz;
      const double sway_mm = behind ? 0.0 : 1.5 * region * std::sin(kTwoPi * 1.4 * t);
      const double scale = r.alpha_px / (depth_mm - ahead.at(t));
      const auto follow = [&](const Gusts& gusts, double at_s) {
        return r.alpha_px / kNear_mm * gusts.followed(at_s, kCorner_hz, kLag_s);
      };
      const double u = scale * (x_mm + sway_mm - along.at(t)), v = scale * (y_mm - across.at(t));
      const double pitch = camera.gimbal * follow(across, t) / r.alpha_px;
      const double deep = std::cos(pitch) - v / r.alpha_px * std::sin(pitch);
      r.u_px(k, j) = r.cx_px + u / deep + camera.stabiliser * follow(along, middle_s) + kNoise_px * noise.gaussian();
      r.v_px(k, j) = r.cy_px + (v * std::cos(pitch) + r.alpha_px * std::sin(pitch)) / deep +
                     camera.stabiliser * follow(across, middle_s) + kNoise_px * noise.gaussian();
    }
  }
  return r;
}

std::vector<ClosureStep> absorbed_in(const Camera& camera) {
  ObservationLevel level(gusty_record(camera));
  (void)level.fit();
  return level.absorbed();
}

TEST(Stabiliser, FramesThatFollowTheCameraAreNamedWithGainCornerAndLag) {
  for (const double gain : {0.15, 0.7}) {
    const auto found = absorbed_in({.stabiliser = gain});
    ASSERT_EQ(found.size(), 1U) << gain;
    EXPECT_EQ(found[0].effect, "stabiliser");
    SCOPED_TRACE(parameters_text(found[0]));
    const std::array truth{100.0 * gain, kCorner_hz, kLag_s};
    for (std::size_t i = 0; i < 3; ++i) {
      const ParameterValue& value = found[0].parameters.at(i);
      EXPECT_NEAR(value.value, truth[i], 4.0 * value.sigma.value_or(0.0)) << value.name;
      EXPECT_LT(value.sigma.value_or(1e9), 0.25 * truth[i]) << value.name;
    }
  }
}

TEST(Stabiliser, ACameraInGustsHasNone) { EXPECT_TRUE(absorbed_in({}).empty()); }

TEST(Stabiliser, AGimbalThatTurnsAgainstTheGustsIsNone) {
  for (const ClosureStep& step : absorbed_in({.gimbal = 0.3})) EXPECT_NE(step.effect, "stabiliser");
}

// Frames that are shifted as a whole look to a rolling shutter's model like a readout of another length or a view that
// is not perpendicular.
TEST(Stabiliser, WhatItPretendsIsTakenBack) {
  ObservationLevel level(gusty_record({.stabiliser = 0.2, .readout_frames = 0.6}));
  ClosureOptions options;
  options.n_surrogates = 8;
  std::vector<std::string> told;
  options.progress = [&](const auto& progress) { told.push_back(progress.words); };
  const ClosureResult result = close_loop(level, options);
  ASSERT_EQ(result.steps.size(), 1U);
  EXPECT_EQ(result.steps[0].effect, "stabiliser");
  EXPECT_THAT(told, ::testing::Contains(::testing::HasSubstr("is removed: a motion that the model leaves free")));
}

}  // namespace
}  // namespace core::closure

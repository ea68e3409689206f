#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/closure/noise_stream.h"
#include "core/closure/observation/free_motions.h"
#include "core/closure/observation/observation_level.h"

namespace core::closure {
namespace {

using ::testing::Contains;
using ::testing::Not;

constexpr double kTwoPi = 6.283185307179586;

// Narrow-band noise about `hz`, of unit rms: a resonance driven by white noise.
std::vector<double> resonance(double hz, double rate_hz, Eigen::Index n, std::uint64_t seed) {
  NoiseStream noise(seed);
  const double w = kTwoPi * hz / rate_hz, r = std::exp(-0.02 * w);
  std::vector<double> out;
  double last = 0.0, before = 0.0, squares = 0.0;
  for (Eigen::Index k = 0; k < n; ++k) {
    const double now = 2.0 * r * std::cos(w) * last - r * r * before + noise.gaussian();
    before = last, last = now, squares += now * now;
    out.push_back(now);
  }
  for (double& value : out) value /= std::sqrt(squares / static_cast<double>(n));
  return out;
}

struct Moves {
  double background_mm = 0.0, ground_mm = 0.0, breathing = 0.0, yaw_rad = 0.0;
  double background_x_mm = 0.0;  // of the background's middle
  bool has_background = true;
};

// A base and three storeys at 2 m, a background at 4 m, ten points each, seen by a hovering camera; noise of 0.03 px.
// The storeys answer to the ground with twice its motion. The focus breathes about (120, -60) px, the camera yaws.
ObservationRecord hovering_record(const Moves& moves) {
  constexpr Eigen::Index kFrames = 1800;
  constexpr double kCentre_u = 120.0, kCentre_v = -60.0;
  ObservationRecord r;
  r.rate_hz = 30.0, r.alpha_px = 1800.0, r.cx_px = 960.0, r.cy_px = 540.0, r.width_px = 1920, r.height_px = 1080;
  const Eigen::Index n_regions = moves.has_background ? 5 : 4, n_points = 10 * n_regions;
  for (Eigen::Index i = 0; i < n_regions; ++i) {
    Region region;
    region.name = "region" + std::to_string(i);
    region.role = i == 4 ? RegionRole::kBackground : i == 0 ? RegionRole::kBase : RegionRole::kStructure;
    r.regions.push_back(region);
  }
  const auto own = resonance(2.3, r.rate_hz, kFrames, 11), floors = resonance(1.4, r.rate_hz, kFrames, 12),
             focus = resonance(0.6, r.rate_hz, kFrames, 13), tail = resonance(0.9, r.rate_hz, kFrames, 14),
             yaws = resonance(0.8, r.rate_hz, kFrames, 15);
  r.u_px.resize(kFrames, n_points), r.v_px.resize(kFrames, n_points);
  NoiseStream noise(5);
  for (Eigen::Index j = 0; j < n_points; ++j) {
    const auto region = static_cast<int>(j / 10), i = static_cast<int>(j % 10);
    r.region_of_point.push_back(static_cast<std::size_t>(j / 10));
    r.sigma_px.push_back(0.03);
    const bool behind = region == 4;
    const double depth_mm = behind ? 4000.0 : 2000.0;
    const double x_mm =
        (behind ? moves.background_x_mm : 0.0) + (behind ? 140.0 : 40.0) * (static_cast<double>((7 * i) % 10) - 4.5);
    const double y_mm = behind ? 110.0 * (i - 4.5) : 250.0 - 160.0 * region + 11.0 * (i - 4.5);
    for (Eigen::Index k = 0; k < kFrames; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const double t = static_cast<double>(k) / r.rate_hz;
      const double camera_x = 12.0 * std::sin(kTwoPi * 0.11 * t) + 0.3 * tail[at],
                   camera_y = 7.0 * std::sin(kTwoPi * 0.17 * t + 1.0),
                   camera_z = 15.0 * std::sin(kTwoPi * 0.07 * t + 2.0);
      const double moved_mm = behind
                                  ? moves.background_mm * own[at]
                                  : moves.ground_mm * own[at] * (region == 0 ? 1.0 : 2.0) + region * 1.5 * floors[at];
      const double scale = r.alpha_px / (depth_mm - camera_z), grown = 1.0 + moves.breathing * focus[at];
      const double u = kCentre_u + grown * (scale * (x_mm + moved_mm - camera_x) - kCentre_u),
                   v = kCentre_v + grown * (scale * (y_mm - camera_y) - kCentre_v);
      const double yaw = moves.yaw_rad * yaws[at], ahead = std::cos(yaw) - u / r.alpha_px * std::sin(yaw);
      r.u_px(k, j) = r.cx_px + (u * std::cos(yaw) + r.alpha_px * std::sin(yaw)) / ahead + 0.03 * noise.gaussian();
      r.v_px(k, j) = r.cy_px + v / ahead + 0.03 * noise.gaussian();
    }
  }
  return r;
}

std::vector<ClosureStep> found_in(const Moves& moves) {
  ObservationLevel level(hovering_record(moves));
  (void)level.fit();
  return level.absorbed();
}

std::string names(const std::vector<ClosureStep>& steps) {
  std::string out;
  for (const ClosureStep& step : steps) out += (out.empty() ? "" : " + ") + step.effect;
  return out;
}

TEST(AbsorbedEffects, AnIdealHoverHasNone) { EXPECT_EQ(names(found_in({})), ""); }

TEST(AbsorbedEffects, ABackgroundThatSwaysIsNamedWithItsFrequencyAndSize) {
  const auto found = found_in({.background_mm = 0.2});
  ASSERT_EQ(names(found), "moving background");
  EXPECT_NEAR(found[0].parameters[0].value, 2.3, 0.1);
  EXPECT_EQ(found[0].parameters[1].name, "rms along u");
  EXPECT_NEAR(found[0].parameters[1].value, 0.2 * 1800.0 / 4000.0, 0.02);
  EXPECT_GT(found[0].score, found[0].threshold);
}

TEST(AbsorbedEffects, AGroundThatShakesTheStructureIsNoMovingBackground) {
  EXPECT_EQ(names(found_in({.ground_mm = 0.2})), "");
}

TEST(AbsorbedEffects, FocusBreathingIsNamedWithItsSizeAndCentre) {
  const auto found = found_in({.breathing = 4e-4});
  ASSERT_EQ(names(found), "focus breathing");
  SCOPED_TRACE(parameters_text(found[0]));
  const std::vector<ParameterValue>& values = found[0].parameters;
  EXPECT_NEAR(values[0].value, 0.04, 0.008);
  EXPECT_NEAR(values[1].value, 120.0, 3.0 * values[1].sigma.value_or(0.0));
  EXPECT_NEAR(values[2].value, -60.0, 3.0 * values[2].sigma.value_or(0.0));
  EXPECT_LT(values[1].sigma.value_or(1e9), 60.0);
}

// It zooms what it sees beside the optical axis: the background here, and not the structure.
TEST(AbsorbedEffects, ACameraThatTurnsIsNoFocusBreathing) {
  EXPECT_EQ(names(found_in({.yaw_rad = 5e-4, .background_x_mm = 900.0})), "");
  EXPECT_EQ(names(found_in({.breathing = 4e-4, .background_x_mm = 900.0})), "focus breathing");
}

TEST(AbsorbedEffects, WithoutABackgroundBothAreReportedAsNotObservable) {
  const auto reported = [](bool has_background) {
    ObservationLevel level(hovering_record({.background_mm = 0.2, .has_background = has_background}));
    (void)level.fit();
    EXPECT_EQ(level.absorbed().empty(), !has_background);
    std::vector<std::string> out;
    for (const NotObservable& one : level.not_observable()) out.push_back(one.effect);
    return out;
  };
  EXPECT_THAT(reported(false), Contains("moving background"));
  EXPECT_THAT(reported(false), Contains("focus breathing"));
  EXPECT_THAT(reported(true), Not(Contains("moving background")));
}

TEST(AbsorbedEffects, AnEffectTakenOutOfTheCatalogueIsNotNamed) {
  ObservationLevel level(hovering_record({.background_mm = 0.2}));
  level.forget("moving background");
  (void)level.fit();
  EXPECT_EQ(names(level.absorbed()), "");
}

TEST(FreeMotions, NothingIsLeftOfASeriesThatFollowsItsCauseLate) {
  Eigen::MatrixXd cause(1, 2000);
  const std::vector<double> course = resonance(0.5, 30.0, 2000, 3);
  for (Eigen::Index k = 0; k < cause.cols(); ++k) cause(0, k) = course[static_cast<std::size_t>(k)];
  Eigen::RowVectorXd late = Eigen::RowVectorXd::Zero(2000);
  late.tail(1999) = 3.0 * cause.row(0).head(1999);
  EXPECT_LT(beyond_causes(late, cause).norm(), 0.01 * late.norm());
}

TEST(FreeMotions, WhiteNoiseHasUnitPowerInEveryBin) {
  NoiseStream noise(9);
  Eigen::MatrixXd series(4, 1500);
  for (double& value : series.reshaped()) value = noise.gaussian();
  const TaperedSpectra spectra = tapered_spectra(series, 25.0);
  EXPECT_NEAR(spectra.bins.middleCols(4, spectra.bins.cols() - 8).cwiseAbs2().mean(), 1.0, 0.05);
  EXPECT_NEAR(spectra.independent, 1500.0 / 2048.0, 1e-12);
  EXPECT_EQ(spectra.bin_of(2.5), std::lround(2.5 / spectra.bin_hz));
}

}  // namespace
}  // namespace core::closure

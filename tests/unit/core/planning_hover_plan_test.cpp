#include "core/planning/hover_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace core::planning {
namespace {

PlanInput paper_frame() {
  PlanInput input;
  input.length_mm = 840.0;
  input.positions = even_positions(StructureKind::kShearChain, 6);
  for (const double f : {1.657, 5.04, 8.14, 10.83, 12.93, 14.34}) input.modes.push_back({f, 0.01, {}, {}});
  input.distance_mm = 2000.0;
  input.rates_hz = {24, 25, 29.97, 30, 50, 60};
  return input;
}

const CameraOption& option(const HoverPlan& plan, double rate_hz, bool turned) {
  return *std::find_if(plan.options.begin(), plan.options.end(),
                       [&](const CameraOption& o) { return o.rate_hz == rate_hz && o.turned == turned; });
}

TEST(HoverPlan, PaperFrameAt25Fps) {
  const HoverPlan plan = make_plan(paper_frame());
  EXPECT_NEAR(plan.mm_per_px, 0.95238, 1e-5);
  EXPECT_NEAR(plan.structure_px, 882.0, 1e-9);
  EXPECT_TRUE(plan.fits);
  EXPECT_NEAR(plan.delay_span_frames, 0.65 * 882.0 / 1080.0 * 5.0 / 6.0, 1e-9);  // floors 1 to 6 of six storeys
  EXPECT_DOUBLE_EQ(plan.max_frequency_hz, 16.0);
  EXPECT_NEAR(plan.modes[4].place.apparent_hz, 12.07, 2e-3);
  EXPECT_NEAR(plan.modes[5].place.apparent_hz, 10.66, 2e-3);
  for (const std::size_t i : {0U, 1U, 2U}) EXPECT_EQ(plan.modes[i].place.outlook, FoldOutlook::kDirect);
  for (const std::size_t i : {3U, 4U, 5U}) {
    EXPECT_EQ(plan.modes[i].place.outlook, FoldOutlook::kResolved);
    EXPECT_GT(*plan.modes[i].place.margin, 0.6);
  }
  ASSERT_EQ(plan.overlaps.size(), 1U);  // 4 and 6
  EXPECT_EQ(plan.overlaps[0].first, 3U);
  EXPECT_EQ(plan.overlaps[0].second, 5U);
  EXPECT_NEAR(plan.needed_s, 345.78, 0.01);  // damping of mode 1
  EXPECT_EQ(plan.segment, 512);
}

TEST(HoverPlan, TurnedCameraSeesNoDelaysOfAStandingFrame) {
  const HoverPlan plan = make_plan(paper_frame());
  EXPECT_EQ(option(plan, 25.0, false).n_open, 0);
  EXPECT_EQ(option(plan, 25.0, true).n_open, 3);
  EXPECT_EQ(option(plan, 25.0, true).n_folded, 2);
}

TEST(HoverPlan, RecommendsTheNearestRateWithoutTrouble) {
  const HoverPlan plan = make_plan(paper_frame());
  const CameraOption& best = plan.options[plan.best_option];
  EXPECT_DOUBLE_EQ(best.rate_hz, 29.97);
  EXPECT_FALSE(best.turned);
  EXPECT_EQ(best.n_folded + best.n_open + best.n_overlaps, 0);
  EXPECT_EQ(option(plan, 50.0, false).obstacle, Obstacle::kReadoutTooLong);  // 26 ms do not fit into a frame of 20 ms
}

TEST(HoverPlan, KeepsTheGivenCameraWhereNothingIsBetter) {
  PlanInput input = paper_frame();
  input.modes.resize(3);
  EXPECT_EQ(make_plan(input).best_option, 0U);
}

TEST(HoverPlan, BridgeIsResolvedByTurningTheCamera) {
  PlanInput input = paper_frame();
  input.kind = StructureKind::kBeam;
  input.axis = LongAxis::kHorizontal;
  input.positions = even_positions(StructureKind::kBeam, 6);
  input.modes = {{2.1, 0.01, {}, {}}, {8.3, 0.01, {}, {}}, {14.34, 0.01, {}, {}}};
  input.rates_hz = {};
  const HoverPlan plan = make_plan(input);
  EXPECT_EQ(plan.modes[2].place.outlook, FoldOutlook::kNoDelays);
  EXPECT_TRUE(plan.options[plan.best_option].turned);
  EXPECT_EQ(plan.options[plan.best_option].n_open, 0);
}

TEST(HoverPlan, RatesThatPutAModeIntoTheHoverBandAreAvoided) {
  PlanInput input = paper_frame();
  input.camera.readout_s = 0.010;
  input.camera.exposure_s = 0.0;
  input.modes = {{3.0, 0.01, {}, {}}, {25.2, 0.01, {}, {}}};
  const HoverPlan plan = make_plan(input);
  EXPECT_NEAR(plan.modes[1].place.apparent_hz, 0.2, 2e-3);
  EXPECT_TRUE(plan.modes[1].in_hover_band);
  EXPECT_GT(option(plan, 25.0, false).n_hidden, 0);
  EXPECT_EQ(plan.options[plan.best_option].n_hidden, 0);
}

TEST(HoverPlan, ExposureLossAndAmplitudeOverTheFloor) {
  PlanInput input = paper_frame();
  input.camera.exposure_s = 0.038;
  for (PlannedMode& mode : input.modes) mode.rms_mm = 0.01;
  const HoverPlan plan = make_plan(input);
  EXPECT_NEAR(plan.modes[5].exposure_gain, std::abs(std::sin(M_PI * 14.34 * 0.038) / (M_PI * 14.34 * 0.038)), 1e-12);
  EXPECT_LT(plan.modes[5].exposure_gain, kLeastExposureGain);
  for (const ModePlan& mode : plan.modes) {  // 20 log10 of the ratio to the least amplitude, plus its 10 dB
    EXPECT_NEAR(*mode.over_floor_db, 10.0 + 20.0 * std::log10(0.01 / mode.least_rms_mm), 1e-9);
  }
}

TEST(HoverPlan, BatteryLimitsTheHover) {
  PlanInput input = paper_frame();
  input.battery_s = 120.0;
  const HoverPlan plan = make_plan(input);
  EXPECT_DOUBLE_EQ(plan.hover_s, 120.0);
  EXPECT_GT(plan.needed_s, 120.0);
  EXPECT_NEAR(plan.modes[0].relative_sigma_damping, 0.2 * std::sqrt(345.78 / 120.0), 1e-4);
  input.hover_s = 60.0;
  EXPECT_DOUBLE_EQ(make_plan(input).hover_s, 60.0);
}

TEST(HoverPlan, TooCloseDoesNotFit) {
  PlanInput input = paper_frame();
  input.distance_mm = 1700.0;
  EXPECT_FALSE(make_plan(input).fits);
  EXPECT_TRUE(option(make_plan(input), 25.0, true).fits);  // 1920 px are enough
}

TEST(HoverPlan, GivenShapesGoBeforeIdealOnes) {
  PlanInput input = paper_frame();
  input.modes.resize(1);
  input.modes[0].frequency_hz = 14.34;
  input.modes[0].shape = {1, 0, 0, 0, 0, 0};  // a single region shows no phase
  EXPECT_EQ(make_plan(input).modes[0].place.outlook, FoldOutlook::kAmbiguous);
}

TEST(HoverPlan, RefusesBadInputNamingTheValue) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refusal = [](auto change) {
    PlanInput input = paper_frame();
    change(input);
    try {
      (void)make_plan(input);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_NE(refusal([&](PlanInput& i) { i.modes[2].frequency_hz = nan; }).find("nan"), std::string::npos);
  EXPECT_NE(refusal([](PlanInput& i) { i.modes[0].frequency_hz = -1.0; }).find("-1"), std::string::npos);
  EXPECT_NE(refusal([](PlanInput& i) { i.modes[2].frequency_hz = 3.0; }).find("ascending"), std::string::npos);
  EXPECT_NE(refusal([](PlanInput& i) { i.camera.rate_hz = 0.0; }).find("frame rate"), std::string::npos);
  EXPECT_NE(refusal([](PlanInput& i) { i.modes.clear(); }).find("modes is 0"), std::string::npos);
  EXPECT_NE(refusal([](PlanInput& i) { i.modes.resize(41, {20.0, 0.01, {}, {}}); }).find("41"), std::string::npos);
  EXPECT_NE(refusal([](PlanInput& i) {
              i.modes.push_back({20.0, 0.01, {}, {}});
            }).find("each floor"),
            std::string::npos);
  EXPECT_NE(refusal([](PlanInput& i) { i.modes[1].damping_ratio = 0.0; }).find("damping"), std::string::npos);
  EXPECT_NE(refusal([](PlanInput& i) { i.modes[1].rms_mm = -2.0; }).find("amplitude"), std::string::npos);
  EXPECT_NE(refusal([](PlanInput& i) { i.modes[1].shape = {1.0}; }).find("shape"), std::string::npos);
  EXPECT_NE(refusal([](PlanInput& i) { i.distance_mm = 0.0; }).find("distance"), std::string::npos);
  EXPECT_NE(refusal([&](PlanInput& i) { i.length_mm = nan; }).find("length"), std::string::npos);
  EXPECT_NE(refusal([](PlanInput& i) { i.points_per_region = 0; }).find("points"), std::string::npos);
  EXPECT_NE(refusal([&](PlanInput& i) { i.point_sigma_px = nan; }).find("noise"), std::string::npos);
  EXPECT_NE(refusal([](PlanInput& i) { i.rates_hz = {30.0, 0.0}; }).find("rate"), std::string::npos);
  EXPECT_NE(refusal([](PlanInput& i) { i.hover_s = 2.0; }).find("256 frames"), std::string::npos);
  EXPECT_NE(refusal([](PlanInput& i) { i.relative_sigma_damping = 0.0; }).find("sigma"), std::string::npos);
}

}  // namespace
}  // namespace core::planning

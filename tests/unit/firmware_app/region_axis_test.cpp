#include "firmware_app/config/region_axis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "firmware_app/config/config_yaml.h"
#include "firmware_app/report/axis_findings.h"

namespace app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kText = R"(camera: {driver: synthetic}
regions:
  - {name: deck, rect: [0, 0, 40, 40]}
  - {name: pier, rect: [0, 50, 40, 40], axis: v}
  - {name: wall, rect: [0, 100, 40, 40], role: background}
)";

TEST(RegionAxis, IsSoughtWhereNoneIsDeclared) {
  AppConfig config = parse_config(kText, "a.yaml");
  EXPECT_TRUE(seeks_axes(config));
  EXPECT_EQ(config.regions[0].axis_from, core::AxisFrom::kSought);
  EXPECT_EQ(config.regions[1].axis_from, core::AxisFrom::kDeclared);
  take_axes(config, {{core::AxisFrom::kMotion, 90.0, false}, {core::AxisFrom::kMotion, 0.0, true}, {}});
  EXPECT_FALSE(seeks_axes(config));
  EXPECT_EQ(axis_words(config.regions[0]), "v");
  EXPECT_EQ(axis_words(config.regions[1]), "v");
  EXPECT_FALSE(config.regions[1].both_axes);
  EXPECT_EQ(found_axes_words(config), "axis of deck: v, found from the motion");
  EXPECT_THAT(axis_caveats(config), IsEmpty());
}

TEST(RegionAxis, WhatWasFoundComesBackFromARecord) {
  for (const char* found : {"auto 90", "auto -30", "auto both", "auto still", "auto", "u", "40"}) {
    AppConfig config = parse_config(kText, "a.yaml");
    ASSERT_TRUE(put_axis(found, config.regions[0])) << found;
    const AppConfig back = parse_config(config_yaml(config), "record");
    EXPECT_EQ(back.regions[0].axis_from, config.regions[0].axis_from) << found;
    EXPECT_EQ(back.regions[0].axis_deg, config.regions[0].axis_deg) << found;
    EXPECT_EQ(back.regions[0].both_axes, config.regions[0].both_axes) << found;
    EXPECT_EQ(back.regions[1].axis_deg, 90.0);
  }
  core::Region region;
  for (const char* wrong : {"auto w", "autov", "auto 400", "", "x"}) EXPECT_FALSE(put_axis(wrong, region)) << wrong;
}

TEST(RegionAxis, NothingThatMovesIsSaid) {
  AppConfig config = parse_config(kText, "a.yaml");
  take_axes(config, {{}, {}, {}});
  EXPECT_THAT(axis_caveats(config), ElementsAre(HasSubstr("the axis of deck is not declared, and nothing moved")));
}

// Ten points of two regions; the second moves along v by `amplitude_px`.
core::MotionAxes moving(const std::vector<core::Region>& regions, double amplitude_px) {
  core::MotionAxes axes(regions, 20);
  core::TrackFrame frame;
  frame.points.resize(20);
  for (int k = 0; k < 200; ++k) {
    frame.t_start_ns = 40'000'000LL * k;
    for (std::size_t i = 0; i < 20; ++i) {
      const double v = i < 10 ? 0.0 : amplitude_px * std::sin(2.0 * std::numbers::pi * 3.0 * 0.04 * k);
      frame.points[i] = {
          10.0 + 0.1 * v, 20.0 + v, 0.01, static_cast<std::uint32_t>(i), static_cast<std::uint16_t>(i < 10 ? 0 : 1),
          true,           true};
    }
    axes.add(frame);
  }
  return axes;
}

TEST(MotionAcross, IsToldWithTheAxisToSet) {
  std::vector<core::Region> regions(2);
  regions[0].name = "ground", regions[0].role = core::RegionRole::kGround;
  regions[1].name = "deck";
  EXPECT_THAT(motion_across_words(regions, moving(regions, 0.8)),
              ElementsAre("deck moved across the axis u up to 10 times as much as along it, which is not measured: set "
                          "regions[].axis to v or both"));
  EXPECT_THAT(motion_across_words(regions, moving(regions, 0.01)), IsEmpty());
  regions[1].axis_deg = 90.0;
  EXPECT_THAT(motion_across_words(regions, moving(regions, 0.8)), IsEmpty());
  regions[1].axis_deg = 0.0, regions[1].both_axes = true;
  EXPECT_THAT(motion_across_words(regions, moving(regions, 0.8)), IsEmpty());
}

}  // namespace
}  // namespace app

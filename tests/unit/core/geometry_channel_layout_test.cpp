#include "core/geometry/channel_layout.h"

#include <gtest/gtest.h>

#include "core/types/witness.h"

namespace core {
namespace {

Region region(const char* name, RegionRole role, bool both_axes = false) {
  Region out;
  out.name = name, out.role = role, out.both_axes = both_axes;
  return out;
}

const std::vector<Region> kRegions{region("base", RegionRole::kBase), region("roof", RegionRole::kStructure, true),
                                   region("hill", RegionRole::kBackground), region("wall", RegionRole::kBackground)};
const std::vector<RegionPoints> kPoints{{8, 0.001}, {8, 0.002}, {5, 0.003}, {9, 0.004}};

TEST(ChannelLayout, OneChannelAlongAnAxisTwoOfBothNoneOfWhatIsStatic) {
  const std::vector<ChannelInfo> channels = channel_layout(kRegions, kPoints);
  ASSERT_EQ(channels.size(), 3U);
  EXPECT_EQ(channels[0].name, "base");
  EXPECT_TRUE(channels[0].is_base);
  EXPECT_EQ(channels[1].name, "roof.u");
  EXPECT_EQ(channels[2].name, "roof.v");
  EXPECT_EQ(channels[2].direction_v, 1.0);
  EXPECT_EQ(channels[2].row_delay_s, 0.002);
}

TEST(ChannelLayout, TheStaticRegionOfMostPointsIsWitnessOfEachDirectionOnce) {
  const std::vector<ChannelInfo> channels = channel_layout(kRegions, kPoints);
  const std::vector<ChannelInfo> witnesses = witness_layout(kRegions, kPoints, channels, {});
  ASSERT_EQ(witnesses.size(), 2U);  // base and roof.u share a direction
  for (const ChannelInfo& witness : witnesses) {
    EXPECT_EQ(witness.name, "wall");
    EXPECT_TRUE(witness.is_witness);
    EXPECT_EQ(witness.row_delay_s, 0.004);
  }
  EXPECT_TRUE(witness_layout(kRegions, kPoints, channels, {10, 0.0}).empty());
}

TEST(ChannelLayout, TheStaticRegionIsWitnessOfTheCamerasRotationWhereItsPointsSpread) {
  const std::vector<ChannelInfo> channels = channel_layout(kRegions, kPoints);
  std::vector<RegionPoints> points = kPoints;
  points[3].spread_px = 50.0;
  const std::vector<ChannelInfo> witnesses = witness_layout(kRegions, points, channels, {3, 50.0});
  ASSERT_EQ(witnesses.size(), 3U);
  EXPECT_FALSE(witnesses_turn(witnesses[1]));
  EXPECT_TRUE(witnesses_turn(witnesses[2]));
  EXPECT_EQ(witnesses[2].row_delay_s, 0.004);
  EXPECT_EQ(witness_layout(kRegions, points, channels, {3, 51.0}).size(), 2U);
}

}  // namespace
}  // namespace core

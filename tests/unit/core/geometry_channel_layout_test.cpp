#include "core/geometry/channel_layout.h"

#include <gtest/gtest.h>

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
  const std::vector<ChannelInfo> witnesses = witness_layout(kRegions, kPoints, channels, 3);
  ASSERT_EQ(witnesses.size(), 2U);  // base and roof.u share a direction
  for (const ChannelInfo& witness : witnesses) {
    EXPECT_EQ(witness.name, "wall");
    EXPECT_TRUE(witness.is_witness);
    EXPECT_EQ(witness.row_delay_s, 0.004);
  }
  EXPECT_TRUE(witness_layout(kRegions, kPoints, channels, 10).empty());
}

}  // namespace
}  // namespace core

#include "core/identification/record_poles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/simulated_structure.h"

namespace core {
namespace {

using test_support::SimulatedStructure;

RecordPoles poles_of(const SimulatedStructure& structure, const IdentifierConfig& config) {
  const CpsdSums sums = structure.spectra();
  FoldingConfig folding{structure.rate_hz, config.max_frequency_hz, {}};
  for (const ChannelInfo& channel : structure.channels()) folding.delay_s.push_back(channel.row_delay_s);
  return find_poles(sums, config, structure.channels(), folding, CameraLeakage(sums, structure.channels()));
}

// At 25 samples a second, a mode of 14.34 Hz folds to 10.66 Hz beside one of 10.83 Hz; their widths are 0.22 and 0.29.
SimulatedStructure folded() {
  SimulatedStructure structure;
  structure.rate_hz = 25.0;
  structure.segment = 512;
  structure.delay_step_s = 0.9 * 0.15 / 25.0;
  return structure;
}

IdentifierConfig searching(int block_rows = 0) {
  IdentifierConfig config;
  config.max_frequency_hz = 20.0, config.block_rows = block_rows;
  return config;
}

TEST(RecordPoles, LinesCloserThanTheirWidthsGetALongerWindow) {
  const RecordPoles close = poles_of(folded(), searching());
  ASSERT_EQ(close.status, "ok");
  EXPECT_EQ(close.fit.era.block_rows, 51) << "360 rows of seven channels";
  const RecordPoles apart = poles_of({}, {});
  ASSERT_EQ(apart.status, "ok");
  EXPECT_EQ(apart.fit.era.block_rows, 34) << "240 rows";
}

TEST(RecordPoles, ADeclaredWindowStays) { EXPECT_EQ(poles_of(folded(), searching(20)).fit.era.block_rows, 20); }

TEST(RecordPoles, ListsAreParallelAndLinesNameTheirPoles) {
  const RecordPoles poles = poles_of(folded(), searching());
  ASSERT_EQ(poles.observed.size(), poles.unfolded.size());
  ASSERT_EQ(poles.leaks.size(), poles.unfolded.size());
  ASSERT_FALSE(poles.lines.empty());
  for (const PoleCluster& line : poles.lines) {
    EXPECT_GE(line.presence, 0.25);
    EXPECT_NE(std::find(line.members.begin(), line.members.end(), line.i_representative), line.members.end());
    for (const std::size_t member : line.members) {
      ASSERT_LT(member, poles.unfolded.size());
      EXPECT_NEAR(poles.unfolded[member].pole.apparent_hz / line.apparent_hz, 1.0, 0.05);
      EXPECT_EQ(poles.observed[member].order, poles.orders[static_cast<std::size_t>(poles.unfolded[member].i_order)]);
    }
  }
}

}  // namespace
}  // namespace core

#include "firmware_app/chain/structure_comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace app {
namespace {

using ::testing::HasSubstr;

// The paper's six measured frequencies (Yoon et al. 2017): a shear frame with a soft first storey.
core::ModalEstimate estimate_at(double t_s) {
  core::ModalEstimate out;
  out.t_stream_ns = static_cast<std::int64_t>(1e9 * t_s);
  out.duration_s = t_s, out.n_samples = static_cast<std::uint64_t>(25.0 * t_s);
  for (const double hz : {1.657, 5.018, 8.112, 10.838, 12.865, 14.145}) {
    core::Mode mode;
    mode.frequency_hz = hz, mode.frequency_std_hz = 0.001 * hz;
    mode.shape.assign(2, 1.0);
    out.modes.push_back(mode);
  }
  return out;
}

core::structure::DeclaredFrame frame() {
  core::structure::DeclaredFrame out;
  out.n_storeys = 6;
  return out;
}

std::vector<core::ChannelInfo> channels() {
  std::vector<core::ChannelInfo> out(2);
  out[0].name = "floor1", out[1].name = "floor2";
  return out;
}

bool always() { return true; }

TEST(StructureComparison, ReportsOnceAPeriod) {
  StructureComparison comparison(frame(), channels(), 60.0);
  EXPECT_FALSE(comparison.is_due(core::ModalEstimate{}));  // no modes
  ASSERT_TRUE(comparison.is_due(estimate_at(20.0)));
  const core::closure::ClosureReport first = comparison.report(estimate_at(20.0), always);
  EXPECT_EQ(first.refused, "");
  EXPECT_EQ(first.number, 0U);
  EXPECT_EQ(first.result.level, "structure");
  EXPECT_EQ(first.duration_s, 20.0);
  EXPECT_GT(first.result.baseline_rms, 0.0);
  EXPECT_FALSE(comparison.is_due(estimate_at(79.0)));
  ASSERT_TRUE(comparison.is_due(estimate_at(80.0)));
  EXPECT_EQ(comparison.report(estimate_at(80.0), always).number, 1U);
}

TEST(StructureComparison, SaysWhyNothingCanBeConcluded) {
  core::structure::DeclaredFrame unknown_channel = frame();
  unknown_channel.floors = {"floor1", "floor2", "floor3", "floor4", "floor5", "floor6"};
  const auto report = StructureComparison(unknown_channel, channels(), 60.0).report(estimate_at(20.0), always);
  EXPECT_THAT(report.refused, HasSubstr("no channel `floor3`"));
  EXPECT_EQ(report.result.level, "structure");
}

TEST(StructureComparison, EndsWhenItIsStopped) {
  StructureComparison comparison(frame(), channels(), 60.0);
  EXPECT_THROW((void)comparison.report(estimate_at(20.0), [] { return false; }), std::runtime_error);
}

}  // namespace
}  // namespace app

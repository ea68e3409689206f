#include "core/spectrum/merge_sums.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "core/identification/identifier.h"
#include "tests/support/simulated_structure.h"

namespace core {
namespace {

using test_support::SimulatedStructure;
using testing::HasSubstr;

RecordSums record(std::uint64_t seed, double duration_s = 120.0) {
  SimulatedStructure structure;
  structure.seed = seed;
  structure.duration_s = duration_s;
  structure.segment = 512;
  return {structure.spectra(), structure.channels()};
}

TEST(AddRecord, IsTheRecordOfBothInEitherOrder) {
  RecordSums a = record(1), b = record(2);
  const RecordSums one = a, two = b;
  add_record(a, two);
  add_record(b, one);
  EXPECT_EQ(a.sums.n_segments, one.sums.n_segments + two.sums.n_segments);
  EXPECT_EQ(a.sums.n_samples, one.sums.n_samples + two.sums.n_samples);
  for (std::size_t k = 0; k < a.sums.data_sum.size(); ++k) {
    EXPECT_NEAR(std::abs(a.sums.data_sum[k] - (one.sums.data_sum[k] + two.sums.data_sum[k])), 0.0, 1e-12);
  }
  const ModalEstimate ab = Identifier({}, a.channels).identify(a.sums),
                      ba = Identifier({}, b.channels).identify(b.sums);
  ASSERT_EQ(ab.modes.size(), ba.modes.size());
  for (std::size_t m = 0; m < ab.modes.size(); ++m) {
    EXPECT_NEAR(ab.modes[m].frequency_hz, ba.modes[m].frequency_hz, 1e-9 * ab.modes[m].frequency_hz);
  }
}

TEST(AddRecord, KeepsBlocksThatAddUpAndStandardDeviationsThatShrink) {
  RecordSums sum = record(1);
  const ModalEstimate alone = Identifier({}, sum.channels).identify(sum.sums);
  for (std::uint64_t seed = 2; seed <= 6; ++seed) add_record(sum, record(seed));
  ASSERT_GE(sum.sums.n_blocks, 10U);
  ASSERT_LE(sum.sums.n_blocks, sum.sums.blocks.size());
  std::uint64_t n_segments = 0;
  for (std::size_t b = 0; b < sum.sums.n_blocks; ++b) n_segments += sum.sums.blocks[b].n_segments;
  EXPECT_EQ(n_segments, sum.sums.n_segments);
  const ModalEstimate all = Identifier({}, sum.channels).identify(sum.sums);
  ASSERT_FALSE(alone.modes.empty() || all.modes.empty());
  ASSERT_TRUE(alone.modes[0].frequency_std_hz && all.modes[0].frequency_std_hz);
  EXPECT_LT(*all.modes[0].frequency_std_hz, 0.8 * *alone.modes[0].frequency_std_hz);
}

TEST(AddRecord, RefusesWhatIsNotTheSameMeasurementAndSaysWhy) {
  const RecordSums one = record(1, 30.0);
  RecordSums other = one;
  EXPECT_EQ(why_not_addable(one, other), "");
  other.channels[2].row_delay_s += 2e-4;
  EXPECT_THAT(why_not_addable(one, other), HasSubstr("seen 0.2 ms later"));
  other = one;
  other.channels[1].name = "elsewhere";
  EXPECT_THAT(why_not_addable(one, other), HasSubstr("'elsewhere'"));
  other = one;
  other.channels[1].n_integrations = 2;
  EXPECT_THAT(why_not_addable(one, other), HasSubstr("quantities"));
  other = one;
  other.channels.pop_back();
  EXPECT_THAT(why_not_addable(one, other), HasSubstr("channels"));
  other = one;
  other.sums.rate_hz *= 1.001;
  EXPECT_THAT(why_not_addable(one, other), HasSubstr("samples a second"));
  other = one;
  other.sums.rate_hz = std::nan("");
  EXPECT_THROW(add_record(other, one), std::invalid_argument);
  other = one;
  other.sums.n_fft *= 2;
  EXPECT_THAT(why_not_addable(one, other), HasSubstr("segments"));
  other = one;
  other.sums.window_power *= 1.5;
  EXPECT_THAT(why_not_addable(one, other), HasSubstr("windows"));
  EXPECT_THROW(add_record(other, one), std::invalid_argument);
}

}  // namespace
}  // namespace core

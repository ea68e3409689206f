#include "core/spectrum/merge_sums.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "core/identification/identifier.h"
#include "core/spectrum/welch_cpsd.h"
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

RecordSums sum_of(const std::vector<RecordSums>& records) {
  std::uint64_t n_segments = 0;
  for (const RecordSums& one : records) n_segments += one.sums.n_segments;
  SumOfRecords sum(n_segments, 20);
  for (const RecordSums& one : records) sum.add(one);
  return sum.total();
}

TEST(SumOfRecords, IsTheRecordOfAllInAnyOrder) {
  const RecordSums one = record(1), two = record(2);
  const RecordSums a = sum_of({one, two}), b = sum_of({two, one});
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

TEST(SumOfRecords, OfOneIsThatRecord) {
  const RecordSums one = record(1), sum = sum_of({one});
  EXPECT_EQ(sum.sums.data_sum, one.sums.data_sum);
  ASSERT_EQ(sum.sums.n_blocks, one.sums.n_blocks);
  for (std::size_t b = 0; b < sum.sums.n_blocks; ++b)
    EXPECT_EQ(sum.sums.blocks[b].data_sum, one.sums.blocks[b].data_sum);
}

TEST(SumOfRecords, HasBlocksOfEqualLengthThatAddUpWhateverTheRecords) {
  std::vector<RecordSums> records;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) records.push_back(record(seed, seed % 2 == 0 ? 60.0 : 240.0));
  const RecordSums sum = sum_of(records);
  ASSERT_GE(sum.sums.n_blocks, 10U);
  ASSERT_LE(sum.sums.n_blocks, 20U);
  std::uint64_t n_segments = 0, least = sum.sums.n_segments, most = 0;
  for (std::size_t b = 0; b < sum.sums.n_blocks; ++b) {
    const std::uint64_t n = sum.sums.blocks[b].n_segments;
    n_segments += n, least = std::min(least, n), most = std::max(most, n);
  }
  EXPECT_EQ(n_segments, sum.sums.n_segments);
  EXPECT_LE(most, least + least / 2 + 2);
}

TEST(SumOfRecords, HasStandardDeviationsThatShrink) {
  std::vector<RecordSums> records;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) records.push_back(record(seed));
  const RecordSums sum = sum_of(records);
  const ModalEstimate alone = Identifier({}, records[0].channels).identify(records[0].sums),
                      all = Identifier({}, sum.channels).identify(sum.sums);
  ASSERT_FALSE(alone.modes.empty() || all.modes.empty());
  ASSERT_TRUE(alone.modes[0].frequency_std_hz && all.modes[0].frequency_std_hz);
  EXPECT_LT(*all.modes[0].frequency_std_hz, 0.8 * *alone.modes[0].frequency_std_hz);
}

TEST(SumOfRecords, HasNoBlocksWhereARecordHasNone) {
  RecordSums one = record(1), two = record(2);
  two.sums.blocks.clear(), two.sums.n_blocks = 0;
  EXPECT_EQ(sum_of({one, two}).sums.n_blocks, 0U);
  EXPECT_EQ(sum_of({two, one}).sums.n_blocks, 0U);
}

// A sine of each channel's own amplitude, seen delay_s later in each.
RecordSums sine(const std::vector<double>& delay_s) {
  constexpr double kRate_hz = 25.0, kSine_hz = 3.1;
  RecordSums out;
  WelchConfig config{.n_channels = static_cast<int>(delay_s.size()), .segment = 256, .rate_hz = kRate_hz};
  WelchCpsd cpsd(config);
  std::vector<double> value(delay_s.size());
  const std::vector<std::uint8_t> seen(delay_s.size(), 1);
  for (int k = 0; k < 4096; ++k) {
    for (std::size_t c = 0; c < value.size(); ++c)
      value[c] =
          (1.0 + static_cast<double>(c)) * std::sin(2.0 * std::numbers::pi * kSine_hz * (k / kRate_hz + delay_s[c]));
    (void)cpsd.push(value, seen);
  }
  out.sums = cpsd.sums();
  for (const double delay : delay_s) {
    out.channels.push_back({});
    out.channels.back().row_delay_s = delay;
  }
  return out;
}

TEST(SumOfRecords, BringsRowDelaysToThoseOfTheFirst) {
  const RecordSums first = sine({0.0, 0.010, 0.020}), elsewhere = sine({0.002, 0.0095, 0.023});
  const RecordSums aligned = sum_of({first, elsewhere}), wanted = sum_of({first, first});
  RecordSums as_it_is = elsewhere;
  for (std::size_t c = 0; c < 3; ++c) as_it_is.channels[c].row_delay_s = first.channels[c].row_delay_s;
  const RecordSums unaligned = sum_of({first, as_it_is});
  const auto farthest = [&](const RecordSums& sum) {
    double most = 0.0, largest = 0.0;
    for (std::size_t k = 0; k < wanted.sums.data_sum.size(); ++k) {
      most = std::max(most, std::abs(sum.sums.data_sum[k] - wanted.sums.data_sum[k]));
      largest = std::max(largest, std::abs(wanted.sums.data_sum[k]));
    }
    return most / largest;
  };
  EXPECT_LT(farthest(aligned), 0.003);
  EXPECT_GT(farthest(unaligned), 0.02);
  std::complex<double> of_blocks = 0.0, of_sums = 0.0;
  for (const auto& value : aligned.sums.data_sum) of_sums += value;
  for (std::size_t b = 0; b < aligned.sums.n_blocks; ++b) {
    for (const auto& value : aligned.sums.blocks[b].data_sum) of_blocks += value;
  }
  EXPECT_NEAR(std::abs(of_blocks - of_sums), 0.0, 1e-9 * std::abs(of_sums));
}

TEST(SumOfRecords, RefusesRowDelaysThatAreTooFarApart) {
  EXPECT_THROW((void)sum_of({sine({0.0, 0.01}), sine({0.0, 0.0145})}), std::invalid_argument);
}

TEST(SumOfRecords, RefusesWhatIsNotTheSameMeasurementAndSaysWhy) {
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
  EXPECT_THROW((void)sum_of({other, one}), std::invalid_argument);
  other = one;
  other.sums.n_fft *= 2;
  EXPECT_THAT(why_not_addable(one, other), HasSubstr("segments"));
  other = one;
  other.sums.window_power *= 1.5;
  EXPECT_THAT(why_not_addable(one, other), HasSubstr("windows"));
  EXPECT_THROW((void)sum_of({other, one}), std::invalid_argument);
}

}  // namespace
}  // namespace core

#include "core/spectrum/welch_cpsd.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace core {
namespace {

WelchConfig config_of(int n_channels, int segment, double overlap) {
  WelchConfig config;
  config.n_channels = n_channels;
  config.segment = segment;
  config.overlap = overlap;
  config.rate_hz = 25.0;
  return config;
}

void push_noise(WelchCpsd& welch, int n_channels, int n, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> gaussian;
  std::vector<double> value(static_cast<std::size_t>(n_channels));
  const std::vector<std::uint8_t> seen(value.size(), 1);
  for (int t = 0; t < n; ++t) {
    for (double& v : value) v = gaussian(random);
    welch.push(value, seen);
  }
}

bool all_finite(const CpsdSums& sums) {
  for (const auto& z : sums.data_sum) {
    if (!std::isfinite(z.real()) || !std::isfinite(z.imag())) return false;
  }
  for (const auto& z : sums.mask_sum) {
    if (!std::isfinite(z.real()) || !std::isfinite(z.imag())) return false;
  }
  return true;
}

TEST(WelchCpsd, TellsWhenASegmentIsComplete) {
  WelchCpsd welch(config_of(1, 8, 0.5));
  const std::vector<double> value{1.0};
  const std::vector<std::uint8_t> seen{1};
  std::vector<int> hops;
  for (int t = 1; t <= 20; ++t) {
    if (welch.push(value, seen)) hops.push_back(t);
  }
  EXPECT_EQ(hops, (std::vector<int>{8, 12, 16, 20}));
  EXPECT_EQ(welch.n_hops(), 4U);
  EXPECT_EQ(welch.sums().n_samples, 20U);
  EXPECT_EQ(welch.hop(), 4);
}

TEST(WelchCpsd, CountsEveryMissingChannelSample) {
  WelchCpsd welch(config_of(3, 8, 0.5));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  welch.push(std::vector<double>{1.0, 2.0, 3.0}, std::vector<std::uint8_t>{1, 0, 1});
  welch.push(std::vector<double>{1.0, nan, 3.0}, std::vector<std::uint8_t>{1, 1, 1});
  welch.push_missing();
  EXPECT_EQ(welch.sums().n_missing, 5U);
  EXPECT_EQ(welch.sums().n_samples, 3U);
}

// A sample marked as seen that is not finite is a gap; a value marked "not seen" is never read.
TEST(WelchCpsd, NaNAndUnseenValuesChangeNothingButTheMask) {
  WelchCpsd a(config_of(1, 16, 0.5));
  WelchCpsd b(config_of(1, 16, 0.5));
  for (int t = 0; t < 64; ++t) {
    const bool lost = t % 5 == 2;
    const double x = std::sin(0.7 * t);
    a.push(std::vector<double>{lost ? std::numeric_limits<double>::infinity() : x}, std::vector<std::uint8_t>{1});
    b.push(std::vector<double>{lost ? 1e300 : x}, std::vector<std::uint8_t>{static_cast<std::uint8_t>(lost ? 0 : 1)});
  }
  EXPECT_TRUE(all_finite(a.sums()));
  EXPECT_EQ(a.sums().data_sum, b.sums().data_sum);
  EXPECT_EQ(a.sums().mask_sum, b.sums().mask_sum);
  EXPECT_EQ(a.sums().n_missing, b.sums().n_missing);
}

TEST(WelchCpsd, ARecordWithoutASampleStaysFinite) {
  WelchCpsd welch(config_of(2, 16, 0.75));
  for (int t = 0; t < 40; ++t) welch.push_missing();
  welch.flush();
  EXPECT_TRUE(all_finite(welch.sums()));
  for (const auto& z : welch.sums().mask_sum) EXPECT_EQ(std::abs(z), 0.0);
}

TEST(WelchCpsd, FlushTakesTheRestOnceAndOnlyIfThereIsOne) {
  WelchCpsd whole(config_of(1, 16, 0.5));
  push_noise(whole, 1, 32, 1);
  EXPECT_EQ(whole.n_hops(), 3U);
  whole.flush();
  EXPECT_EQ(whole.n_hops(), 3U) << "nothing new since the last segment";

  WelchCpsd rest(config_of(1, 16, 0.5));
  push_noise(rest, 1, 35, 1);
  rest.flush();
  EXPECT_EQ(rest.n_hops(), 4U);
  rest.flush();
  EXPECT_EQ(rest.n_hops(), 4U);

  WelchCpsd empty(config_of(1, 16, 0.5));
  empty.flush();
  EXPECT_EQ(empty.n_hops(), 0U);
}

// flush() adds what a segment of the remainder's length gives: 13 of 37 samples, after hops at 16, 24 and 32.
TEST(WelchCpsd, FlushAddsASegmentOfTheRemaindersLength) {
  std::vector<double> value(37);
  std::mt19937 random(4);
  for (double& v : value) v = std::normal_distribution<double>()(random);
  WelchCpsd whole(config_of(1, 16, 0.5)), last(config_of(1, 13, 0.5));
  const std::vector<std::uint8_t> seen{1};
  for (const double v : value) whole.push(std::span(&v, 1), seen);
  const CpsdSums before = whole.sums();
  whole.flush();
  for (std::size_t t = 24; t < value.size(); ++t) last.push(std::span(&value[t], 1), seen);
  ASSERT_EQ(last.n_hops(), 1U);
  for (std::size_t k = 0; k < before.data_sum.size(); ++k) {
    EXPECT_NEAR(std::abs(whole.sums().data_sum[k] - before.data_sum[k] - last.sums().data_sum[k]), 0.0, 1e-12);
    EXPECT_NEAR(std::abs(whole.sums().mask_sum[k] - before.mask_sum[k] - last.sums().mask_sum[k]), 0.0, 1e-12);
  }
}

// The hover moves by far more than a mode: where a record ends, that must not spread over all frequencies.
TEST(WelchCpsd, SlowMotionStaysSlowAtTheRecordsEnd) {
  WelchCpsd welch(config_of(1, 256, 0.5));
  const std::vector<std::uint8_t> seen{1};
  for (int t = 0; t < 256 + 60; ++t) {
    const double v = 20.0 * std::sin(0.01 * t);
    welch.push(std::span(&v, 1), seen);
  }
  welch.flush();
  const CpsdSums& sums = welch.sums();
  EXPECT_EQ(sums.n_segments, 2U);
  const double slow = sums.data_sum[1].real(), fast = sums.data_sum[static_cast<std::size_t>(sums.n_bins() / 2)].real();
  EXPECT_LT(fast, 1e-9 * slow);
}

TEST(WelchCpsd, ForgetsAConstant) {
  WelchCpsd welch(config_of(1, 32, 0.5));
  for (int t = 0; t < 100; ++t) {
    welch.push(std::vector<double>{t % 7 == 0 ? 0.0 : 512.0},
               std::vector<std::uint8_t>{static_cast<std::uint8_t>(t % 7 == 0 ? 0 : 1)});
  }
  for (const auto& z : welch.sums().data_sum) EXPECT_LT(std::abs(z), 1e-18);
}

TEST(WelchCpsd, BlocksAreTheRecordInOrderAndAddUpToItsSums) {
  WelchConfig config = config_of(2, 16, 0.5);
  config.n_blocks = 4;
  for (const int n_samples : {24, 40, 48, 56, 1000}) {
    WelchCpsd welch(config);
    push_noise(welch, 2, n_samples, 3);
    const CpsdSums& sums = welch.sums();
    std::vector<std::complex<double>> data(sums.data_sum.size()), mask(data.size());
    std::uint64_t n_segments = 0;
    ASSERT_LE(sums.n_blocks, 4U);
    EXPECT_GE(sums.n_blocks, std::min<std::uint64_t>(2, sums.n_segments));
    for (std::size_t b = 0; b < sums.n_blocks; ++b) {
      n_segments += sums.blocks[b].n_segments;
      // All but the last are equal.
      if (b + 1 < sums.n_blocks) {
        EXPECT_EQ(sums.blocks[b].n_segments, sums.blocks[0].n_segments);
      }
      for (std::size_t k = 0; k < data.size(); ++k) {
        data[k] += sums.blocks[b].data_sum[k];
        mask[k] += sums.blocks[b].mask_sum[k];
      }
    }
    EXPECT_EQ(n_segments, sums.n_segments);
    for (std::size_t k = 0; k < data.size(); ++k) {
      EXPECT_NEAR(std::abs(data[k] - sums.data_sum[k]), 0.0, 1e-9 * (1.0 + std::abs(data[k])));
      EXPECT_NEAR(std::abs(mask[k] - sums.mask_sum[k]), 0.0, 1e-9 * (1.0 + std::abs(mask[k])));
    }
  }
}

TEST(WelchCpsd, KeptSegmentsAddUpToTheSums) {
  WelchConfig config = config_of(2, 16, 0.5);
  config.n_kept_segments = 8;
  WelchCpsd welch(config);
  push_noise(welch, 2, 60, 3);
  welch.flush();
  const CpsdSums& sums = welch.sums();
  ASSERT_EQ(sums.segments.n_added(), sums.n_segments);
  ASSERT_EQ(sums.segments.first(), 0U);
  for (int bin = 0; bin < sums.n_bins(); ++bin) {
    std::complex<double> sum = 0.0;
    for (std::uint64_t k = 0; k < sums.segments.n_added(); ++k) {
      const auto at = static_cast<std::size_t>(bin);
      sum += std::complex<double>(sums.segments.value(k, 0)[at]) *
             std::conj(std::complex<double>(sums.segments.value(k, 1)[at]));
    }
    const std::complex<double> whole = sums.data_sum[static_cast<std::size_t>(bin * sums.n_pairs() + 1)];
    EXPECT_NEAR(std::abs(sum - whole), 0.0, 1e-4) << bin;
  }
  EXPECT_EQ(sums.segments.segment(1).start, 8U);
  EXPECT_EQ(sums.segments.segment(sums.n_segments - 1).n_samples, 12U) << "what is left at the end, with its overlap";
}

TEST(WelchCpsd, OnlyTheNewestSegmentsAreKept) {
  WelchConfig config = config_of(3, 16, 0.5);
  config.n_kept_segments = 4;
  WelchCpsd welch(config);
  push_noise(welch, 3, 100, 4);
  const SegmentSpectra& kept = welch.sums().segments;
  EXPECT_EQ(kept.n_added() - kept.first(), 4U);
  EXPECT_EQ(kept.segment(kept.first()).start, 8 * kept.first());
  EXPECT_EQ(kept.seen(kept.first(), 2), 1.0F);
  const SegmentSpectra some = kept.of_channels({2, 0});
  EXPECT_EQ(some.n_channels(), 2U);
  EXPECT_EQ(some.value(kept.first(), 0)[3], kept.value(kept.first(), 2)[3]);
  EXPECT_EQ(some.value(kept.first(), 1)[5], kept.value(kept.first(), 0)[5]);
  welch.restart(25.0);
  EXPECT_EQ(welch.sums().segments.n_added(), 0U);
}

TEST(WelchCpsd, EmptySumsHaveTheShapeOfRealOnes) {
  const WelchConfig config = config_of(3, 20, 0.5);
  WelchCpsd welch(config);
  push_noise(welch, 3, 50, 2);
  const CpsdSums empty = WelchCpsd::empty_sums(config);
  EXPECT_EQ(empty.n_fft, 64);
  EXPECT_EQ(empty.n_fft, welch.sums().n_fft);
  EXPECT_EQ(empty.data_sum.size(), welch.sums().data_sum.size());
  EXPECT_EQ(empty.mask_sum.size(), 33U * 6U);
  EXPECT_EQ(empty.window_power, welch.sums().window_power);
  EXPECT_EQ(empty.n_segments, 0U);
}

TEST(WelchCpsd, RefusesWhatCannotBeASpectrumAndSaysWhy) {
  const auto refusal = [](const WelchConfig& config) -> std::string {
    try {
      WelchCpsd welch(config);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  WelchConfig no_rate = config_of(1, 8, 0.5);
  no_rate.rate_hz = std::numeric_limits<double>::quiet_NaN();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal(config_of(0, 8, 0.5)).find("channel"), std::string::npos);
  for (const int segment : {-5, 0, 3})
    EXPECT_NE(refusal(config_of(1, segment, 0.5)).find("segment"), std::string::npos)
        << refusal(config_of(1, segment, 0.5));
  for (const double overlap : {-0.1, 1.0, nan})
    EXPECT_NE(refusal(config_of(1, 8, overlap)).find("overlap"), std::string::npos);
  EXPECT_NE(refusal(no_rate).find("rate"), std::string::npos);
}

TEST(CpsdSums, NumbersThePairsOfTheUpperTriangle) {
  int expected = 0;
  for (int i = 0; i < 5; ++i) {
    for (int j = i; j < 5; ++j) EXPECT_EQ(CpsdSums::pair_index(i, j, 5), expected++);
  }
}

}  // namespace
}  // namespace core

#include "firmware_app/report/plot/spectral_matrix.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include "firmware_app/report/plot/spectrum_curves.h"

namespace app {
namespace {

using Complex = std::complex<double>;

// Sums of `n_segments` equal segments in which a shape moves with power `strong`, and another, orthogonal to it, with
// `weak`, at every bin.
core::CpsdSums sums_of(const std::vector<Complex>& first, const std::vector<Complex>& second, double strong,
                       double weak, int n_fft, std::uint64_t n_segments) {
  core::CpsdSums sums;
  sums.n_channels = static_cast<int>(first.size()), sums.n_fft = n_fft, sums.rate_hz = 50.0;
  sums.n_segments = n_segments, sums.window_power = 2.0;
  for (std::uint64_t i = 0; i < n_segments; ++i) sums.weight.add_one();
  for (int k = 0; k < sums.n_bins(); ++k) {
    for (std::size_t i = 0; i < first.size(); ++i) {
      for (std::size_t j = i; j < first.size(); ++j) {
        const Complex one = first[i] * std::conj(first[j]), two = second[i] * std::conj(second[j]);
        sums.data_sum.push_back(static_cast<double>(n_segments) * (strong * one + weak * two));
      }
    }
  }
  return sums;
}

const std::vector<Complex> kFirst{{0.0, 0.6}, {0.8, 0.0}, {0.0, 0.0}}, kSecond{{0.0, 0.0}, {0.0, 0.0}, {1.0, 0.0}};

TEST(SpectralMatrix, GivesPowersShareAndShapeOfOneLine) {
  const core::CpsdSums sums = sums_of(kFirst, kSecond, 9.0, 1.0, 64, 5);
  const SpectralLines found = spectral_lines(&sums, nullptr);
  ASSERT_EQ(found.lines.size(), 32U);  // bins 1 .. 32
  EXPECT_EQ(found.n_singular, 3U);
  const SpectralLine& line = found.lines[3];
  EXPECT_DOUBLE_EQ(line.frequency_hz, 4 * 50.0 / 64);
  // One-sided density: 2 x power / (rate x window power).
  EXPECT_NEAR(line.singular[0], 2.0 * 9.0 / 100.0, 1e-12);
  EXPECT_NEAR(line.singular[1], 2.0 * 1.0 / 100.0, 1e-12);
  EXPECT_NEAR(line.share, 0.9, 1e-12);
  // The largest component is 1; the first channel leads it by a quarter of a period.
  EXPECT_NEAR(std::abs(line.shape[1] - 1.0), 0.0, 1e-12);
  EXPECT_NEAR(std::abs(line.shape[0] - Complex(0.0, 0.75)), 0.0, 1e-12);
  EXPECT_NEAR(std::abs(line.shape[2]), 0.0, 1e-12);
  EXPECT_NEAR(found.lines.back().singular[0], 9.0 / 100.0, 1e-12);  // the Nyquist bin has one side only
  EXPECT_EQ(found.nearest(4 * 50.0 / 64 + 0.1), 3U);
  // The sum of the singular values is the summed density.
  EXPECT_NEAR(total_density(sums)[3].y, line.singular[0] + line.singular[1] + line.singular[2], 1e-12);
}

TEST(SpectralMatrix, LeavesOutExcludedChannelsAndBrokenLines) {
  core::CpsdSums sums = sums_of(kFirst, kSecond, 9.0, 1.0, 64, 1);
  core::ModalEstimate estimate;
  estimate.channels.resize(3);
  estimate.channels[1].takes_part = false;
  sums.data_sum[5 * 6 + 2] = std::numeric_limits<double>::quiet_NaN();  // bin 5, channels 0 and 2
  const SpectralLines found = spectral_lines(&sums, &estimate);
  EXPECT_EQ(found.lines.size(), 31U);
  EXPECT_EQ(found.channels, (std::vector<std::size_t>{0, 2}));
  EXPECT_EQ(found.n_singular, 1U);  // one segment gives one value
  EXPECT_EQ(found.lines.front().shape[1], Complex(0.0));
  EXPECT_NEAR(std::abs(found.lines.front().shape[0]), 1.0, 1e-12);
}

TEST(SpectralMatrix, IsBoundedForManyChannelsAndBins) {
  std::vector<Complex> first(64, 0.1), second(64, 0.0);
  second[3] = 1.0;
  const core::CpsdSums many = sums_of(first, second, 2.0, 1.0, 1 << 13, 4);
  const SpectralLines found = spectral_lines(&many, nullptr);
  EXPECT_GE(found.lines.size(), 50U);
  EXPECT_LE(found.lines.size(), 200U);
  EXPECT_TRUE(spectral_lines(nullptr, nullptr).lines.empty());
  const core::CpsdSums too_many =
      sums_of(std::vector<Complex>(129, 1.0), std::vector<Complex>(129, 0.5), 1.0, 1.0, 8, 2);
  EXPECT_TRUE(spectral_lines(&too_many, nullptr).lines.empty());
}

}  // namespace
}  // namespace app

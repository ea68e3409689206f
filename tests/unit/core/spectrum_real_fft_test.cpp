#include "core/spectrum/real_fft.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

namespace core {
namespace {

using Complex = std::complex<double>;

std::vector<double> noise(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> gaussian;
  std::vector<double> x(static_cast<std::size_t>(n));
  for (double& value : x) value = gaussian(random);
  return x;
}

std::vector<Complex> transform(RealFft& fft, const std::vector<double>& x) {
  std::vector<Complex> spectrum(static_cast<std::size_t>(fft.n_bins()));
  fft.forward(x, spectrum);
  return spectrum;
}

Complex direct(const std::vector<double>& x, int k) {
  Complex sum = 0.0;
  const auto n = static_cast<int>(x.size());
  for (int t = 0; t < n; ++t) {
    sum += x[static_cast<std::size_t>(t)] * std::polar(1.0, -2.0 * std::numbers::pi * ((k * t) % n) / n);
  }
  return sum;
}

TEST(RealFft, EqualsTheDirectSum) {
  for (const int n : {4, 8, 16, 64, 256}) {
    RealFft fft(n);
    const std::vector<double> x = noise(n, static_cast<unsigned>(n));
    const std::vector<Complex> spectrum = transform(fft, x);
    ASSERT_EQ(static_cast<int>(spectrum.size()), n / 2 + 1);
    for (int k = 0; k <= n / 2; ++k) {
      EXPECT_LT(std::abs(spectrum[static_cast<std::size_t>(k)] - direct(x, k)), 1e-13 * n) << "n " << n << " bin " << k;
    }
  }
}

TEST(RealFft, InverseUndoesForward) {
  for (const int n : {4, 32, 4096}) {
    RealFft fft(n);
    const std::vector<double> x = noise(n, 1);
    std::vector<double> back(x.size());
    fft.inverse(transform(fft, x), back);
    for (std::size_t t = 0; t < x.size(); ++t) EXPECT_NEAR(back[t], x[t], 1e-13);
  }
}

TEST(RealFft, EndsOfTheSpectrumAreReal) {
  RealFft fft(128);
  const std::vector<Complex> spectrum = transform(fft, noise(128, 3));
  EXPECT_NEAR(spectrum.front().imag(), 0.0, 1e-13);
  EXPECT_NEAR(spectrum.back().imag(), 0.0, 1e-13);
}

TEST(RealFft, RefusesLengthsThatAreNoPowerOfTwo) {
  for (const int n : {-8, 0, 1, 2, 3, 5, 6, 12, 1000}) EXPECT_THROW(RealFft{n}, std::invalid_argument) << n;
}

TEST(NextPowerOfTwo, IsTheSmallestThatReaches) {
  EXPECT_EQ(next_power_of_two(1), 1);
  EXPECT_EQ(next_power_of_two(2), 2);
  EXPECT_EQ(next_power_of_two(3), 4);
  EXPECT_EQ(next_power_of_two(1024), 1024);
  EXPECT_EQ(next_power_of_two(1025), 2048);
}

}  // namespace
}  // namespace core

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/spectrum/real_fft.h"

namespace core {
namespace {

struct Signal {
  std::vector<double> x;
  std::vector<std::complex<double>> spectrum;
};

Signal random_signal(RealFft& fft, std::mt19937& random) {
  std::normal_distribution<double> gaussian;
  Signal signal;
  for (int t = 0; t < fft.size(); ++t) signal.x.push_back(gaussian(random));
  signal.spectrum.resize(static_cast<std::size_t>(fft.n_bins()));
  fft.forward(signal.x, signal.spectrum);
  return signal;
}

TEST(RealFftProperty, Parseval) {
  std::mt19937 random(1);
  for (int n = 4; n <= 8192; n *= 2) {
    RealFft fft(n);
    const Signal signal = random_signal(fft, random);
    double in_time = 0.0;
    for (const double x : signal.x) in_time += x * x;
    double in_frequency = 0.0;
    for (std::size_t k = 0; k < signal.spectrum.size(); ++k) {
      in_frequency += (k == 0 || k + 1 == signal.spectrum.size() ? 1.0 : 2.0) * std::norm(signal.spectrum[k]);
    }
    EXPECT_NEAR(in_frequency / n, in_time, 1e-12 * in_time) << n;
  }
}

TEST(RealFftProperty, IsLinear) {
  std::mt19937 random(2);
  RealFft fft(256);
  for (int trial = 0; trial < 50; ++trial) {
    const Signal a = random_signal(fft, random);
    const Signal b = random_signal(fft, random);
    std::vector<double> sum(256);
    for (std::size_t t = 0; t < 256; ++t) sum[t] = 2.0 * a.x[t] - 3.0 * b.x[t];
    std::vector<std::complex<double>> spectrum(129);
    fft.forward(sum, spectrum);
    for (std::size_t k = 0; k < 129; ++k)
      EXPECT_LT(std::abs(spectrum[k] - (2.0 * a.spectrum[k] - 3.0 * b.spectrum[k])), 1e-11);
  }
}

// A circular shift rotates every bin by its own angle and changes nothing else.
TEST(RealFftProperty, AShiftIsAPhase) {
  std::mt19937 random(3);
  RealFft fft(128);
  for (int trial = 0; trial < 50; ++trial) {
    const Signal signal = random_signal(fft, random);
    const auto shift = static_cast<std::size_t>(random() % 128);
    std::vector<double> shifted(128);
    for (std::size_t t = 0; t < 128; ++t) shifted[(t + shift) % 128] = signal.x[t];
    std::vector<std::complex<double>> spectrum(65);
    fft.forward(shifted, spectrum);
    for (std::size_t k = 0; k < 65; ++k) {
      const double angle = -2.0 * 3.14159265358979323846 * static_cast<double>(k * shift) / 128.0;
      EXPECT_LT(std::abs(spectrum[k] - signal.spectrum[k] * std::polar(1.0, angle)), 1e-11);
    }
  }
}

TEST(RealFftProperty, RoundTrip) {
  std::mt19937 random(4);
  for (int n = 4; n <= 4096; n *= 2) {
    RealFft fft(n);
    const Signal signal = random_signal(fft, random);
    std::vector<double> back(signal.x.size());
    fft.inverse(signal.spectrum, back);
    for (std::size_t t = 0; t < back.size(); ++t) ASSERT_NEAR(back[t], signal.x[t], 1e-13) << n;
  }
}

}  // namespace
}  // namespace core

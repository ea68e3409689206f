#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "core/tracking/klt/fractional_shift.h"
#include "core/tracking/klt/surface_fit.h"
#include "core/tracking/klt/window_sums.h"

namespace core {
namespace {

double shifted(double shift, const std::function<double(double)>& signal) {
  const FractionalShift filter = fractional_shift(shift);
  double sum = 0.0;
  for (std::size_t k = 0; k < filter.taps.size(); ++k)
    sum += filter.taps[k] * signal(filter.first + static_cast<int>(k));
  return sum;
}

TEST(FractionalShift, MovesSinusoidsUpToThreeEighthsOfACycleBySoMuch) {
  for (const double cycles : {0.02, 0.1, 0.2, 0.3, 0.375}) {
    for (const double shift : {-1.0 / 3.0, 0.0, 1.0 / 6.0, 0.5, 0.9, 1.25}) {
      const double k = 2.0 * std::numbers::pi * cycles;
      const auto wave = [&](double x) { return std::sin(k * x + 0.3); };
      EXPECT_NEAR(shifted(shift, wave), wave(-shift), 3e-4) << cycles << ' ' << shift;
    }
  }
}

TEST(FractionalShift, KeepsALine) {
  const auto line = [](double x) { return 7.0 + 3.0 * x; };
  for (const double shift : {-0.4, 0.25, 0.8}) EXPECT_NEAR(shifted(shift, line), line(-shift), 1e-5);
}

TEST(FractionalShift, OfWholeSamplesIsExact) {
  const auto wave = [](double x) { return std::sin(2.9 * x); };
  for (const double shift : {-2.0, 0.0, 3.0}) EXPECT_NEAR(shifted(shift, wave), wave(-shift), 1e-9) << shift;
}

TEST(SurfaceFit, FindsThePolynomialOfItsValues) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  using Fit = SurfaceFit<4, 25>;
  Fit::Values a{}, b{}, weights{}, values{};
  Polynomial<4> truth;
  for (double& factor : truth.factors) factor = unit(random);
  for (std::size_t p = 0; p < a.size(); ++p) {
    a[p] = unit(random), b[p] = unit(random), weights[p] = 0.5 + 0.4 * unit(random);
    values[p] = truth.of({a[p], b[p]});
  }
  const Fit fit(a, b, weights);
  ASSERT_TRUE(fit.is_determined());
  const Polynomial<4> found = fit.to(values);
  for (std::size_t k = 0; k < truth.factors.size(); ++k) EXPECT_NEAR(found.factors[k], truth.factors[k], 1e-8);
}

TEST(SurfaceFit, PlacesOnALineDetermineNoSurface) {
  using Fit = SurfaceFit<4, 25>;
  Fit::Values a{}, b{}, weights{};
  for (std::size_t p = 0; p < a.size(); ++p) a[p] = 0.04 * static_cast<double>(p), b[p] = 2.0 * a[p], weights[p] = 1.0;
  EXPECT_FALSE(Fit(a, b, weights).is_determined());
}

// Also right at the ends of an image's memory: nothing beyond a window is read.
TEST(WindowSums, AreThoseOfThePixelsTimesTheFactors) {
  std::mt19937_64 random(5);
  std::uniform_int_distribution<int> grey(0, 255), factor(-18'000, 18'000);
  for (const int radius : {kWindowRadius, 5}) {
    const int side = side_of(radius), width = side + 4;
    std::vector<std::uint8_t> image(static_cast<std::size_t>(width * side));
    for (auto& pixel : image) pixel = static_cast<std::uint8_t>(grey(random));
    const GrayView gray{image.data(), width, side, static_cast<std::size_t>(width)};
    Phase phase;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const auto i = static_cast<std::size_t>(y * kRow + x);
        phase.step_u[i] = static_cast<std::int16_t>(factor(random));
        phase.step_v[i] = static_cast<std::int16_t>(factor(random));
        phase.texture[i] = static_cast<std::int16_t>(factor(random));
      }
    }
    for (const int u : {radius, width - 2 - radius}) {
      RawWindow window{};
      copy_window(gray, u, radius, radius, window);
      const WindowSums sums = sums_over(window, phase);
      std::int64_t step_u = 0, step_v = 0, texture = 0, sum = 0, square = 0;
      for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
          const auto i = static_cast<std::size_t>(y * kRow + x);
          const int pixel = gray.row(y)[u - radius + x];
          step_u += pixel * phase.step_u[i], step_v += pixel * phase.step_v[i], texture += pixel * phase.texture[i];
          sum += pixel, square += pixel * pixel;
        }
      }
      EXPECT_EQ(sums.step_u, step_u);
      EXPECT_EQ(sums.step_v, step_v);
      EXPECT_EQ(sums.texture, texture);
      EXPECT_EQ(sums.sum, sum);
      EXPECT_EQ(sums.square, square);
    }
  }
}

}  // namespace
}  // namespace core

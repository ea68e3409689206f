#include "core/tracking/klt/point_template.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "core/tracking/klt/interpolated_window.h"
#include "tests/support/analytic_texture.h"
#include "tests/support/gray_view.h"

namespace core {
namespace {

using test_support::AnalyticTexture;
using test_support::view;
constexpr int kWidth = 120, kHeight = 100, kU = 60, kV = 50;

Patch patch_of(const std::function<double(int, int)>& grey) {
  Patch patch{};
  for (int v = 0; v < kPatch; ++v)
    for (int u = 0; u < kPatch; ++u)
      patch[static_cast<std::size_t>(v)][static_cast<std::size_t>(u)] = grey(u - kPatchRadius, v - kPatchRadius);
  return patch;
}

PointTemplate template_of(const Patch& patch, int radius = kWindowRadius) {
  PointTemplate out;
  build_template(patch, radius, 1, out);
  return out;
}

// As linear as the template's step is: by its own grey values, without the image's interpolation.
Patch texture_patch(double du = 0.0, double dv = 0.0) {
  static const AnalyticTexture texture(11);
  return patch_of([&](int u, int v) { return texture.at(kU + u - du, kV + v - dv); });
}

// The step's sum over a patch, px: weights of the spline at whole pixels, then the folded factors.
double step_over(const Patch& patch, const PointTemplate::Factors& step, const PointTemplate& point) {
  constexpr std::array<double, 5> kWeights{1.0 / 120.0, 26.0 / 120.0, 66.0 / 120.0, 26.0 / 120.0, 1.0 / 120.0};
  constexpr int kFirst = kPatchRadius - kFoldedRadius - 2;
  double sum = 0.0;
  for (std::size_t y = 0; y < kFolded; ++y) {
    for (std::size_t x = 0; x < kFolded; ++x) {
      double grey = 0.0;
      for (std::size_t j = 0; j < 5; ++j)
        for (std::size_t i = 0; i < 5; ++i) grey += kWeights[j] * kWeights[i] * patch[y + j + kFirst][x + i + kFirst];
      sum += step[y * kRow + x] * grey;
    }
  }
  return point.px_per_unit * sum;
}

TEST(PointTemplate, KeepsMeanAndVarianceOfTheWindow) {
  const Patch patch = patch_of([](int u, int v) { return 100.0 + ((u + v) % 2 == 0 ? 20.0 : -20.0) + 0.5 * u; });
  const PointTemplate point = template_of(patch, 6);
  double sum = 0.0, squares = 0.0;
  for (int v = -6; v <= 6; ++v) {
    for (int u = -6; u <= 6; ++u) {
      const double grey = patch[static_cast<std::size_t>(v + kPatchRadius)][static_cast<std::size_t>(u + kPatchRadius)];
      sum += grey, squares += grey * grey;
    }
  }
  const double mean = sum / 169.0;
  EXPECT_NEAR(point.mean, mean, 1e-9);
  EXPECT_NEAR(point.variance, squares / 169.0 - mean * mean, 1e-6);
  EXPECT_EQ(point.radius, 6);
}

TEST(PointTemplate, TextureInOneDirectionOrNoneIsNotTrackable) {
  const Patch flat = patch_of([](int, int) { return 90.0; });
  const Patch stripes = patch_of([](int u, int) { return 90.0 + 40.0 * std::sin(0.6 * u); });
  const Patch crossed =
      patch_of([](int u, int v) { return 90.0 + 40.0 * std::sin(0.6 * u) + 40.0 * std::cos(0.5 * v); });
  for (const Patch& patch : {flat, stripes}) {
    EXPECT_FALSE(has_texture(patch, kWindowRadius));
    EXPECT_FALSE(template_of(patch).is_trackable);
  }
  EXPECT_TRUE(has_texture(crossed, kWindowRadius));
  EXPECT_TRUE(template_of(crossed).is_trackable);
}

TEST(PointTemplate, StepIsTheShiftOfTheTextureToFirstOrder) {
  const PointTemplate point = template_of(texture_patch());
  ASSERT_TRUE(point.is_trackable);
  const double zero_u = step_over(texture_patch(), point.step_u, point);
  const double zero_v = step_over(texture_patch(), point.step_v, point);
  EXPECT_NEAR(zero_u, point.px_per_unit * point.origin_u, 1e-6);
  for (const double d : {-0.1, -0.02, 0.05, 0.1}) {
    const Patch along_u = texture_patch(d, 0.0), along_v = texture_patch(0.0, d);
    EXPECT_NEAR(std::abs(step_over(along_u, point.step_u, point) - zero_u), std::abs(d), 0.05 * std::abs(d)) << d;
    EXPECT_NEAR(step_over(along_u, point.step_v, point) - zero_v, 0.0, 0.05 * std::abs(d)) << d;
    EXPECT_NEAR(std::abs(step_over(along_v, point.step_v, point) - zero_v), std::abs(d), 0.05 * std::abs(d)) << d;
  }
}

TEST(PointTemplate, WindowSaysHowFarItLiesBesideTheTemplate) {
  const AnalyticTexture texture(11);
  const cv::Mat still = texture.image(kWidth, kHeight, 0.0, 0.0), moved = texture.image(kWidth, kHeight, 0.2, -0.1);
  Patch patch;
  cut_patch(view(still), kU, kV, patch);
  const PointTemplate point = template_of(patch);
  InterpolatedWindow window;
  window.begin(view(still), point);
  window.move_to(kU, kV, 0.0, 0.0);
  EXPECT_NEAR(window.step().u, 0.0, 1e-4);
  EXPECT_NEAR(window.step().v, 0.0, 1e-4);
  window.begin(view(moved), point);
  window.move_to(kU, kV, 0.0, 0.0);
  EXPECT_NEAR(window.step().u, -0.2, 0.02);  // the texture lies 0.2 px further to the right
  EXPECT_NEAR(window.step().v, 0.1, 0.02);
}

TEST(PointTemplate, GainAndOffsetOfTheLightAreNoStep) {
  const PointTemplate point = template_of(texture_patch());
  Patch lit = texture_patch();
  for (auto& row : lit)
    for (double& grey : row) grey = 1.3 * grey + 20.0;
  // Rounding of the factors leaves a sum over the template itself, the origin: it grows with the gain, nothing else
  // does.
  EXPECT_NEAR(step_over(lit, point.step_u, point), 1.3 * point.px_per_unit * point.origin_u, 0.002);
  EXPECT_NEAR(step_over(lit, point.step_v, point), 1.3 * point.px_per_unit * point.origin_v, 0.002);
  EXPECT_LT(std::abs(point.px_per_unit * point.origin_u), 0.03);
  EXPECT_LT(std::abs(point.px_per_unit * point.origin_v), 0.03);
}

// The step is linear: its response to one pixel at a time, squared and summed. The prefilter, cut off, strengthens fine
// texture by up to 5 % along either axis, so that the noise has up to 1.05^4 times the stated variance.
TEST(PointTemplate, VarianceIsThatOfTheStepOverWhiteNoise) {
  const PointTemplate point = template_of(texture_patch());
  double u2 = 0.0, v2 = 0.0;
  for (std::size_t y = 0; y < kPatch; ++y) {
    for (std::size_t x = 0; x < kPatch; ++x) {
      Patch one{};
      one[y][x] = 1.0;
      const double u = step_over(one, point.step_u, point), v = step_over(one, point.step_v, point);
      u2 += u * u, v2 += v * v;
    }
  }
  for (const double ratio : {u2 / point.variance_u, v2 / point.variance_v}) {
    EXPECT_GT(ratio, 1.0);
    EXPECT_LT(ratio, 1.2155);
  }
}

TEST(PointTemplate, NoiseIsEstimatedFromOnePatch) {
  const auto plane = [](int u, int v) { return 100.0 + 2.0 * u - v; };
  EXPECT_NEAR(template_of(patch_of(plane)).noise, 0.0, 1e-9);
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0.0, 3.0);
  double mean = 0.0;
  for (int k = 0; k < 100; ++k)
    mean += template_of(patch_of([&](int u, int v) { return plane(u, v) + noise(random); })).noise / 100.0;
  EXPECT_NEAR(mean, 9.0, 0.9);
}

TEST(PointTemplate, FineTextureCountsAsNoiseUpToHalfOfTheVariance) {
  const PointTemplate point = template_of(patch_of([](int u, int v) { return (u + v) % 2 == 0 ? 80.0 : 120.0; }));
  EXPECT_NEAR(point.noise, 0.5 * point.variance, 1e-9);
}

}  // namespace
}  // namespace core

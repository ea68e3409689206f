#include "core/tracking/klt/point_template.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <random>

#include "core/tracking/klt/phase_match.h"
#include "tests/support/analytic_texture.h"

namespace core {
namespace {

using test_support::AnalyticTexture;
constexpr double kU = 60.0, kV = 50.0;

Patch patch_of(const std::function<double(int, int)>& grey) {
  Patch patch{};
  for (int v = 0; v < kPatch; ++v)
    for (int u = 0; u < kPatch; ++u)
      patch[static_cast<std::size_t>(v)][static_cast<std::size_t>(u)] =
          static_cast<float>(grey(u - kPatchRadius, v - kPatchRadius));
  return patch;
}

std::unique_ptr<PointTemplate> template_of(const Patch& patch, int radius = kWindowRadius) {
  auto out = std::make_unique<PointTemplate>();
  build_template(patch, radius, 1, *out);
  return out;
}

const AnalyticTexture& texture() {
  static const AnalyticTexture kTexture(11);
  return kTexture;
}
Patch texture_patch() {
  return patch_of([](int u, int v) { return texture().at(kU + u, kV + v); });
}

// The texture about the point as an image shows it where `place` maps the window's pixels to the template's.
RawWindow window_of(const std::function<Vector2(double, double)>& place, double gain = 1.0, double offset = 0.0,
                    int radius = kWindowRadius) {
  RawWindow out{};
  for (int v = -radius; v <= radius + 1; ++v) {
    for (int u = -radius; u <= radius + 1; ++u) {
      const Vector2 at = place(u, v);
      out[static_cast<std::size_t>((v + radius) * kRow + u + radius)] =
          static_cast<std::int16_t>(std::lround(gain * texture().at(kU + at.u, kV + at.v) + offset));
    }
  }
  return out;
}
RawWindow moved_window(double du, double dv, double gain = 1.0, double offset = 0.0, int radius = kWindowRadius) {
  return window_of([&](double u, double v) { return Vector2{u - du, v - dv}; }, gain, offset, radius);
}

TEST(PointTemplate, KeepsMeanAndVarianceOfTheWindow) {
  const Patch patch = patch_of([](int u, int v) { return 100.0 + ((u + v) % 2 == 0 ? 20.0 : -20.0) + 0.5 * u; });
  const auto point = template_of(patch, 6);
  double sum = 0.0, squares = 0.0;
  for (std::size_t v = kPatchRadius - 6; v <= kPatchRadius + 6; ++v) {
    for (std::size_t u = kPatchRadius - 6; u <= kPatchRadius + 6; ++u) {
      const auto grey = static_cast<double>(patch[v][u]);
      sum += grey, squares += grey * grey;
    }
  }
  const double mean = sum / 169.0;
  EXPECT_NEAR(point->mean, mean, 1e-6);
  EXPECT_NEAR(point->variance, squares / 169.0 - mean * mean, 1e-4);
  EXPECT_EQ(point->radius, 6);
}

TEST(PointTemplate, TextureInOneDirectionOrNoneIsNotTrackable) {
  const Patch flat = patch_of([](int, int) { return 90.0; });
  const Patch stripes = patch_of([](int u, int) { return 90.0 + 40.0 * std::sin(0.6 * u); });
  const Patch crossed =
      patch_of([](int u, int v) { return 90.0 + 40.0 * std::sin(0.6 * u) + 40.0 * std::cos(0.5 * v); });
  for (const Patch& patch : {flat, stripes}) {
    EXPECT_FALSE(has_texture(patch, kWindowRadius));
    EXPECT_FALSE(template_of(patch)->is_trackable);
  }
  EXPECT_TRUE(has_texture(crossed, kWindowRadius));
  EXPECT_TRUE(template_of(crossed)->is_trackable);
}

// Rounding to 8 bits alone displaces a point of this texture by about 0.0015 px.
TEST(PointTemplate, EveryPhaseLocatesTheTextureAboutIt) {
  const auto point = template_of(texture_patch());
  ASSERT_TRUE(point->is_trackable);
  for (std::size_t q = 0; q < kPhasesPerPixel; ++q) {
    for (std::size_t p = 0; p < kPhasesPerPixel; ++p) {
      const Phase& phase = point->phases[q][p];
      for (const Vector2& d : {Vector2{0.0, 0.0}, Vector2{0.16, -0.15}, Vector2{-0.25, 0.1}, Vector2{0.02, 0.24}}) {
        const RawWindow window = moved_window(static_cast<double>(p) / kPhasesPerPixel + d.u,
                                              static_cast<double>(q) / kPhasesPerPixel + d.v);
        PhaseMatch match(phase, sums_over(window, phase), kWindowRadius);
        ASSERT_TRUE(match.locate(1.0)) << p << ' ' << q;
        EXPECT_NEAR(match.place().u, d.u, 0.006) << p << ' ' << q;
        EXPECT_NEAR(match.place().v, d.v, 0.006) << p << ' ' << q;
        EXPECT_NEAR(match.gain(), 1.0, 0.005);
        EXPECT_GT(match.judge().correlation, 0.9999);
        EXPECT_LT(match.judge().residual, 0.3);  // rounding: 0.08
      }
    }
  }
}

TEST(PointTemplate, GainAndOffsetOfTheLightMoveNothing) {
  const auto point = template_of(texture_patch());
  const Phase& phase = point->phases[1][2];
  const RawWindow lit = moved_window(2.0 / 3.0 + 0.1, 1.0 / 3.0 - 0.12, 0.7, 30.0);
  for (const double guess : {1.0, 0.7, 0.5}) {
    PhaseMatch match(phase, sums_over(lit, phase), kWindowRadius);
    ASSERT_TRUE(match.locate(guess));
    EXPECT_NEAR(match.gain(), 0.7, 0.005) << guess;
    EXPECT_NEAR(match.place().u, 0.1, 0.006) << guess;
    EXPECT_NEAR(match.place().v, -0.12, 0.006) << guess;
  }
}

TEST(PointTemplate, WhatIsFartherThanAPhaseReachesGivesAStepTowardsIt) {
  const auto point = template_of(texture_patch());
  const Phase& phase = point->phases[0][0];
  const RawWindow window = moved_window(1.5, -1.0);
  PhaseMatch match(phase, sums_over(window, phase), kWindowRadius);
  EXPECT_FALSE(match.locate(1.0));
  EXPECT_LT(length(match.place().u - 1.5, match.place().v + 1.0), 0.9);
}

TEST(PointTemplate, ASmallerWindowIsComparedAsWell) {
  const auto point = template_of(texture_patch(), 6);
  ASSERT_TRUE(point->is_trackable);
  const Phase& phase = point->phases[0][1];
  const RawWindow window = moved_window(1.0 / 3.0 + 0.1, 0.05, 1.0, 0.0, 6);
  PhaseMatch match(phase, sums_over(window, phase), 6);
  ASSERT_TRUE(match.locate(1.0));
  EXPECT_NEAR(match.place().u, 0.1, 0.012);
  EXPECT_NEAR(match.place().v, 0.05, 0.012);
}

// A step is linear in the image: its response to one pixel at a time, squared and summed. Beside the phase a step is
// shorter than the displacement, by which the stated variance exceeds that sum.
TEST(PointTemplate, VarianceIsThatOfTheStepOverWhiteNoise) {
  const auto point = template_of(texture_patch());
  double u2 = 0.0, v2 = 0.0;
  for (const auto& row : point->phases) {
    for (const Phase& phase : row) {
      const double n = kSide * kSide;
      for (std::size_t y = 0; y < kSide; ++y) {
        for (std::size_t x = 0; x < kSide; ++x) {
          const double u = phase.px_per_unit * (phase.step_u[y * kRow + x] - phase.sum_step_u / n);
          const double v = phase.px_per_unit * (phase.step_v[y * kRow + x] - phase.sum_step_v / n);
          u2 += u * u / 9.0, v2 += v * v / 9.0;
        }
      }
    }
  }
  for (const double ratio : {point->variance_u / u2, point->variance_v / v2}) {
    EXPECT_GT(ratio, 0.999);
    EXPECT_LT(ratio, 1.1);
  }
}

// Magnified by 1 % about the point, the texture is found beside it: by how much follows from the template alone.
TEST(PointTemplate, ADeformedImageIsFoundWhereThePullSays) {
  const auto point = template_of(texture_patch());
  const Phase& phase = point->phases[2][1];
  const double u0 = 1.0 / 3.0, v0 = 2.0 / 3.0;
  for (const Deformation& a : {Deformation{0.01, 0.0, 0.0, 0.01}, Deformation{0.0, -0.01, 0.01, 0.0}}) {
    const RawWindow window = window_of([&](double u, double v) {
      const Vector2 x{u - u0, v - v0}, by = a.of(x);
      return Vector2{x.u - by.u, x.v - by.v};
    });
    PhaseMatch match(phase, sums_over(window, phase), kWindowRadius);
    ASSERT_TRUE(match.locate(1.0));
    const Vector2 expected = offset_by(phase.pull, a);
    EXPECT_NEAR(match.place().u, expected.u, 0.003);
    EXPECT_NEAR(match.place().v, expected.v, 0.003);
    EXPECT_NEAR(match.judge().residual - 1.0 / 12.0, match.judge().residual_unit * energy_of(point->deformed, a),
                0.3 * match.judge().residual);
  }
}

TEST(PointTemplate, NoiseIsEstimatedFromOnePatch) {
  const auto plane = [](int u, int v) { return 100.0 + 2.0 * u - v; };
  EXPECT_NEAR(template_of(patch_of(plane))->noise, 0.0, 1e-9);
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0.0, 3.0);
  double mean = 0.0;
  for (int k = 0; k < 100; ++k)
    mean += template_of(patch_of([&](int u, int v) { return plane(u, v) + noise(random); }))->noise / 100.0;
  EXPECT_NEAR(mean, 9.0, 0.9);
}

TEST(PointTemplate, FineTextureCountsAsNoiseUpToHalfOfTheVariance) {
  const auto point = template_of(patch_of([](int u, int v) { return (u + v) % 2 == 0 ? 80.0 : 120.0; }));
  EXPECT_NEAR(point->noise, 0.5 * point->variance, 1e-6);
}

}  // namespace
}  // namespace core

#include "core/tracking/klt/template_average.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/analytic_texture.h"
#include "tests/support/gray_view.h"

namespace core {
namespace {

using test_support::AnalyticTexture;
using test_support::view;
constexpr int kWidth = 240, kHeight = 180;
constexpr double kStrongNoise = 10.0;

std::vector<Vector2> grid() {
  std::vector<Vector2> points;
  for (int v = 40; v <= 140; v += 50)
    for (int u = 40; u <= 200; u += 40) points.push_back({static_cast<double>(u), static_cast<double>(v)});
  return points;
}

struct Rig {
  AnalyticTexture texture{11};
  std::vector<Vector2> points = grid();
  std::vector<KltPoint> found = std::vector<KltPoint>(points.size());
  KltTracker tracker{KltConfig{}};

  explicit Rig(double noise) { tracker.set_keyframe(view(image(0.0, 0.0, noise, 1)), points); }
  [[nodiscard]] cv::Mat image(double du, double dv, double noise, unsigned seed) const {
    return texture.image(kWidth, kHeight, du, dv, noise, seed);
  }
  void find(const cv::Mat& image, double du, double dv) {
    for (std::size_t i = 0; i < points.size(); ++i)
      found[i] = tracker.find(view(image), i, {points[i].u + du, points[i].v + dv});
  }
  // rms error of both axes over seen points, about each point's own mean, over noisy images at places between pixels.
  [[nodiscard]] double scatter(double noise) {
    constexpr unsigned kImages = 40;
    std::vector<double> u(points.size()), v(points.size()), square(points.size()), n(points.size());
    for (unsigned k = 0; k < kImages; ++k) {
      const double to_u = 0.083 * k - 0.4, to_v = 0.31 - 0.071 * k;
      find(image(to_u, to_v, noise, 500 + k), to_u, to_v);
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (!found[i].seen) continue;
        const double du = found[i].position.u - points[i].u - to_u, dv = found[i].position.v - points[i].v - to_v;
        u[i] += du, v[i] += dv, square[i] += du * du + dv * dv, n[i] += 1.0;
      }
    }
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (n[i] < 2.0) continue;
      sum += square[i] - (u[i] * u[i] + v[i] * v[i]) / n[i], count += 2.0 * (n[i] - 1.0);
    }
    return std::sqrt(sum / count);
  }
  int average(double noise) {
    TemplateAverage templates(tracker, 8);
    int n_images = 0;
    for (; !templates.is_done() && n_images < 500; ++n_images) {
      const double du = 0.4 * std::sin(0.7 * n_images), dv = 0.4 * std::cos(0.9 * n_images);
      const cv::Mat now = image(du, dv, noise, 1000 + static_cast<unsigned>(n_images));
      find(now, du, dv);
      templates.add(view(now), found, tracker);
    }
    return n_images;
  }
};

TEST(TemplateAverage, ScattersLessInFaintTexture) {
  Rig rig(kStrongNoise);
  const double before = rig.scatter(kStrongNoise);
  const int n_images = rig.average(kStrongNoise);
  EXPECT_GT(n_images, 16);
  EXPECT_LT(n_images, 500);
  EXPECT_LT(rig.scatter(kStrongNoise), 0.95 * before);
  EXPECT_EQ(rig.tracker.point_template(0).n_averaged, 16);
}

TEST(TemplateAverage, KeepsTheDatum) {
  Rig rig(kStrongNoise);
  const cv::Mat exact = rig.image(0.0, 0.0, 0.0, 1);
  rig.find(exact, 0.0, 0.0);
  const std::vector<KltPoint> before = rig.found;
  (void)rig.average(kStrongNoise);
  rig.find(exact, 0.0, 0.0);
  double moved = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    ASSERT_TRUE(before[i].seen && rig.found[i].seen) << i;
    moved += length(rig.found[i].position.u - before[i].position.u, rig.found[i].position.v - before[i].position.v);
  }
  EXPECT_LT(moved / static_cast<double>(before.size()), rig.scatter(kStrongNoise));
}

TEST(TemplateAverage, LeavesStrongTextureAlone) {
  Rig rig(0.5);
  EXPECT_TRUE(TemplateAverage(rig.tracker).is_done());
}

TEST(TemplateAverage, PatchesBetweenPixelsAreThoseOfTheMovedImage) {
  const Rig rig(0.5);
  Patch between, moved;
  cut_patch_between(view(rig.image(0.0, 0.0, 0.0, 1)), 100.0 - 0.37, 80.0 + 0.61, between);
  cut_patch(view(rig.image(0.37, -0.61, 0.0, 1)), 100, 80, moved);
  double square = 0.0;
  for (std::size_t y = 0; y < kPatch; ++y)
    for (std::size_t x = 0; x < kPatch; ++x) square += std::pow(static_cast<double>(between[y][x] - moved[y][x]), 2);
  EXPECT_LT(std::sqrt(square) / kPatch, 0.5);  // rounding to grey levels alone: 0.4
}

}  // namespace
}  // namespace core

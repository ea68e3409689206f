// Accuracy of the point tracker compared with the Cramer-Rao bound and OpenCV, on texture that is evaluated at each
// pixel's position, never interpolated. Lines of tab-separated values:
//   bound  CYCLES_PER_PX  NOISE  CONTRAST  GRADIENT/NOISE  OURS/BOUND  OPENCV/BOUND  STATED/SCATTER  LOST  POINTS
//   averaged: lines of `bound` for texture whose gradient is below twice the noise, with templates of 16 images
//   drift  OURS_FIRST  OURS_LAST  OPENCV_FIRST  OPENCV_LAST  OURS_DEVIATION    rms px of the first and the last tenth;
//          standard deviation of the difference of ours, of independent errors
//   tracking_accuracy bound|averaged|drift [FRAMES] [SEED]
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "core/tracking/klt/template_average.h"
#include "tests/support/tracker_pair.h"
#include "tests/support/wave_texture.h"

namespace {

using test_support::Error;
using test_support::errors;
using test_support::point_grid;
using test_support::view;
using Texture = test_support::WaveTexture;
constexpr double kTwoPi = 2.0 * std::numbers::pi;

// Mean variance per axis that white noise permits with unknown shift, gain and offset and a noise-free template.
double bound_px2(const Texture& texture, const core::Vector2& point, double noise) {
  std::array<std::array<double, 4>, 4> a{};
  for (int y = -core::kWindowRadius; y <= core::kWindowRadius; ++y) {
    for (int x = -core::kWindowRadius; x <= core::kWindowRadius; ++x) {
      const Texture::Value t = texture.at(point.u + x, point.v + y);
      const std::array<double, 4> row{t.slope_u, t.slope_v, t.grey, 1.0};
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) a[i][j] += row[i] * row[j];
    }
  }
  for (std::size_t k = 3; k >= 2; --k)  // eliminates offset, then gain
    for (std::size_t i = 0; i < k; ++i)
      for (std::size_t j = 0; j < k; ++j) a[i][j] -= a[i][k] * a[k][j] / a[k][k];
  return (noise * noise + 1.0 / 12.0) * 0.5 * (a[0][0] + a[1][1]) / (a[0][0] * a[1][1] - a[0][1] * a[1][0]);
}

struct Scatter {
  double square = 0.0, u = 0.0, v = 0.0;
  int n = 0;
  void add(const Error& e) { square += e.u * e.u + e.v * e.v, u += e.u, v += e.v, ++n; }
  // Sum over the images of the mean square of both axes about the point's own mean.
  [[nodiscard]] double about_mean() const { return n > 1 ? 0.5 * (square - (u * u + v * v) / n) * n / (n - 1.0) : 0.0; }
};

double slope_rms(const Texture& texture, const std::vector<core::Vector2>& points) {
  double sum = 0.0;
  for (const core::Vector2& point : points) {
    const Texture::Value t = texture.at(point.u, point.v);
    sum += 0.5 * (t.slope_u * t.slope_u + t.slope_v * t.slope_v);
  }
  return std::sqrt(sum / static_cast<double>(points.size()));
}

// Templates of faint texture, averaged over the first images as in the service.
void average(core::KltTracker& tracker, const Texture& texture, const std::vector<core::Vector2>& points, double noise,
             unsigned seed) {
  core::TemplateAverage templates(tracker, points.size());
  std::vector<core::KltPoint> found(points.size());
  for (unsigned k = 0; !templates.is_done(); ++k) {
    const double du = 0.43 * std::sin(0.7 * k), dv = 0.37 * std::cos(0.9 * k);
    const cv::Mat image = texture.image(du, dv, noise, seed + 10'000U + k);
    for (std::size_t i = 0; i < points.size(); ++i)
      found[i] = tracker.find(view(image), i, {points[i].u + du, points[i].v + dv});
    templates.add(view(image), found, tracker);
  }
}

void print_bound(int n_images, unsigned seed, bool is_averaged) {
  const std::vector<core::Vector2> points = point_grid();
  for (const double cycles : {0.05, 0.1, 0.2, 0.3, 0.35}) {
    for (const double contrast : {10.0, 20.0, 30.0}) {
      for (const double noise : {1.0, 2.0, 4.0}) {
        const Texture texture(seed, cycles, contrast);
        const double steep = slope_rms(texture, points) / noise;
        if (is_averaged && steep >= 2.0) continue;
        const cv::Mat keyframe = texture.image(0.0, 0.0, noise, seed + 1);
        core::KltTracker tracker{core::KltConfig{}};
        tracker.set_keyframe(view(keyframe), points);
        if (is_averaged) average(tracker, texture, points, noise, seed);
        std::array<std::vector<Scatter>, 2> scatter;
        for (auto& s : scatter) s.resize(points.size());
        std::vector<double> stated2(points.size());
        int n_lost = 0;
        for (int k = 0; k < n_images; ++k) {
          const double du = 0.083 * k - 0.4, dv = 0.31 - 0.071 * k;
          std::vector<double> stated;
          const auto e = errors(tracker, keyframe, texture.image(du, dv, noise, seed + 100U + static_cast<unsigned>(k)),
                                points, du, dv, &stated);
          for (std::size_t i = 0; i < points.size(); ++i) {
            if (!e[0][i].seen) {
              ++n_lost;
              continue;
            }
            stated2[i] += stated[i] * stated[i];
            for (std::size_t which : {0U, 1U}) scatter[which][i].add(e[which][i]);
          }
        }
        double bound = 0.0, ours = 0.0, theirs = 0.0, told = 0.0;
        for (std::size_t i = 0; i < points.size(); ++i) {
          bound += scatter[0][i].n * bound_px2(texture, points[i], noise);
          ours += scatter[0][i].about_mean(), theirs += scatter[1][i].about_mean(), told += stated2[i];
        }
        std::printf("bound\t%g\t%g\t%g\t%.2f\t%.3f\t%.3f\t%.3f\t%d\t%zu\n", cycles, noise, contrast, steep,
                    std::sqrt(ours / bound), std::sqrt(theirs / bound), std::sqrt(told / ours), n_lost,
                    points.size() * static_cast<std::size_t>(n_images));
        std::fflush(stdout);
      }
    }
  }
}

void print_drift(int n_images, unsigned seed) {
  const std::vector<core::Vector2> points = point_grid();
  const Texture texture(seed, 0.15, 20.0);
  const cv::Mat keyframe = texture.image(0.0, 0.0, 1.0, seed + 1);
  core::KltTracker tracker{core::KltConfig{}};
  tracker.set_keyframe(view(keyframe), points);
  std::array<std::array<Scatter, 2>, 2> tenths;
  for (int k = 0; k < n_images; ++k) {
    const bool is_first = k < n_images / 10, is_last = k >= n_images - n_images / 10;
    if (!is_first && !is_last) continue;  // each image is tracked against the keyframe: those between have no influence
    const double du = 2.1 * std::sin(kTwoPi * 1.66 * k / 30.0) + 0.7 * std::sin(kTwoPi * 5.04 * k / 30.0);
    const auto e = errors(tracker, keyframe, texture.image(du, 0.3 * du, 1.0, seed + static_cast<unsigned>(k) + 2),
                          points, du, 0.3 * du);
    for (std::size_t which : {0U, 1U})
      for (const Error& error : e[which])
        if (error.seen) tenths[which][is_last ? 1U : 0U].add(error);
  }
  const auto rms = [](const Scatter& s) { return std::sqrt(0.5 * s.square / std::max(1, s.n)); };
  const auto deviation = [&](const Scatter& s) { return rms(s) / std::sqrt(4.0 * std::max(1, s.n)); };
  std::printf("drift\t%.5f\t%.5f\t%.5f\t%.5f\t%.6f\n", rms(tenths[0][0]), rms(tenths[0][1]), rms(tenths[1][0]),
              rms(tenths[1][1]), std::hypot(deviation(tenths[0][0]), deviation(tenths[0][1])));
}

}  // namespace

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  const std::string what = argc > 1 ? argv[1] : "";
  const int n_images = argc > 2 ? std::atoi(argv[2]) : 12;
  const auto seed = static_cast<unsigned>(argc > 3 ? std::atoi(argv[3]) : 1);
  if (what == "bound" || what == "averaged")
    print_bound(n_images, seed, what == "averaged");
  else if (what == "drift")
    print_drift(n_images, seed);
  else {
    std::fprintf(stderr, "usage: tracking_accuracy bound|averaged|drift [FRAMES] [SEED]\n");
    return 2;
  }
}

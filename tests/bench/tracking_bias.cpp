// Mean error of the point tracker, and of OpenCV's, over the sub-pixel position: without noise, in images that are
// exact except for their rounding to 8 bits. Textures are sums of plane waves; printed dots are dark discs of radius 3
// and 6 px with a blurred edge, each pixel integrated over its area: `dots` have arbitrary sub-pixel positions,
// `aligned` ones all have the same, where a sharp edge causes aliasing that no tracker can resolve. Lines of
// tab-separated values:
//   curve  KIND  CYCLES_PER_PX or RADIUS/BLUR  FRACTION_PX  OURS_PX  OPENCV_PX
//   bias   KIND  CYCLES_PER_PX or RADIUS/BLUR  OURS_PX  OPENCV_PX       the largest of a curve
//   tracking_bias [TEXTURES] [SEED] [PICTURE.svg]
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "firmware_app/report/plot/svg_plot.h"
#include "tests/support/tracker_pair.h"
#include "tests/support/wave_texture.h"

namespace {

using test_support::Error;
using test_support::kPairHeight;
using test_support::kPairWidth;

constexpr std::size_t kFractions = 19;
double fraction(std::size_t k) { return 0.05 * static_cast<double>(k + 1); }

struct Curve {
  std::string kind, of;
  std::array<std::array<double, kFractions>, 2> px{};  // ours, OpenCV's
  [[nodiscard]] double worst(std::size_t which) const {
    double most = 0.0;
    for (const double at : px[which]) most = std::max(most, std::abs(at));
    return most;
  }
};

// One dot at every point of the grid, `phase` px from its pixel's centre (NaN: random), each with its own grey levels.
class Dots {
 public:
  Dots(unsigned seed, double radius, double blur, double phase) : radius_(radius), blur_(blur) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (const core::Vector2& point : test_support::point_grid())
      dots_.push_back({point, 20.0 + 40.0 * unit(random), 180.0 + 50.0 * unit(random),
                       std::isnan(phase) ? unit(random) - 0.5 : phase, std::isnan(phase) ? unit(random) - 0.5 : phase});
  }
  [[nodiscard]] cv::Mat image(double du, double dv) const {
    cv::Mat out(kPairHeight, kPairWidth, CV_8UC1, cv::Scalar(205));
    constexpr int kHalf = test_support::kPairApart / 2;
    for (const Dot& dot : dots_) {
      const int u0 = static_cast<int>(dot.at.u), v0 = static_cast<int>(dot.at.v);
      for (int v = v0 - kHalf; v < v0 + kHalf; ++v)
        for (int u = u0 - kHalf; u < u0 + kHalf; ++u)
          out.at<std::uint8_t>(v, u) =
              cv::saturate_cast<std::uint8_t>(pixel(dot, u - u0 - dot.u - du, v - v0 - dot.v - dv));
    }
    return out;
  }

 private:
  struct Dot {
    core::Vector2 at;
    double dark, bright, u, v;
  };
  // Over the pixel's area, 8 x 8 samples where the edge crosses it.
  [[nodiscard]] double pixel(const Dot& dot, double x, double y) const {
    constexpr int kSamples = 8;
    const double from_edge = std::hypot(x, y) - radius_;
    double share = from_edge > 0.0 ? 0.0 : 1.0;
    if (std::abs(from_edge) < 0.8 + 5.0 * blur_) {
      share = 0.0;
      for (int i = 0; i < kSamples; ++i)
        for (int j = 0; j < kSamples; ++j)
          share +=
              0.5 * std::erfc((std::hypot(x + (i + 0.5) / kSamples - 0.5, y + (j + 0.5) / kSamples - 0.5) - radius_) /
                              (std::sqrt(2.0) * blur_));
      share /= kSamples * kSamples;
    }
    return dot.bright + share * (dot.dark - dot.bright);
  }

  double radius_, blur_;
  std::vector<Dot> dots_;
};

// Adds `share` of the mean error at each fraction.
template <class Picture>
void add(const Picture& picture, double share, Curve& curve) {
  const std::vector<core::Vector2> points = test_support::point_grid();
  const cv::Mat keyframe = picture(0.0);
  core::KltTracker tracker{core::KltConfig{}};
  tracker.set_keyframe(test_support::view(keyframe), points);
  for (std::size_t k = 0; k < kFractions; ++k) {
    const auto found = test_support::errors(tracker, keyframe, picture(fraction(k)), points, fraction(k), fraction(k));
    for (std::size_t which : {0U, 1U})
      for (const Error& error : found[which])
        curve.px[which][k] += share * 0.5 * (error.u + error.v) / static_cast<double>(points.size());
  }
}

void print(const Curve& curve) {
  for (std::size_t k = 0; k < kFractions; ++k)
    std::printf("curve\t%s\t%s\t%.2f\t%.5f\t%.5f\n", curve.kind.c_str(), curve.of.c_str(), fraction(k), curve.px[0][k],
                curve.px[1][k]);
  std::printf("bias\t%s\t%s\t%.5f\t%.5f\n", curve.kind.c_str(), curve.of.c_str(), curve.worst(0), curve.worst(1));
  std::fflush(stdout);
}

std::vector<Curve> measured(int n_textures, unsigned seed) {
  std::vector<Curve> curves;
  for (const char* cycles : {"0.05", "0.1", "0.15", "0.2", "0.25", "0.3", "0.35"}) {
    Curve& curve = curves.emplace_back(Curve{"texture", cycles});
    for (int t = 0; t < n_textures; ++t) {
      const test_support::WaveTexture texture(seed + static_cast<unsigned>(t), std::atof(cycles), 35.0);
      add([&](double shift) { return texture.image(shift, shift, 0.0, 1); }, 1.0 / n_textures, curve);
    }
    print(curve);
  }
  for (const double radius : {3.0, 6.0}) {
    for (const double blur : {0.3, 0.6, 1.2}) {
      const std::string of = fmt::format("{}/{}", radius, blur);
      Curve& curve = curves.emplace_back(Curve{"dots", of});
      for (int t = 0; t < 4 * n_textures; ++t) {
        const Dots dots(seed + static_cast<unsigned>(t), radius, blur, std::nan(""));
        add([&](double shift) { return dots.image(shift, shift); }, 0.25 / n_textures, curve);
      }
      print(curve);
      for (const double phase : {0.0, 0.25, 0.5}) {
        Curve& aligned = curves.emplace_back(Curve{"aligned", fmt::format("{} at {}", of, phase)});
        const Dots dots(seed, radius, blur, phase);
        add([&](double shift) { return dots.image(shift, shift); }, 1.0, aligned);
        print(aligned);
      }
    }
  }
  return curves;
}

// The tracker above, OpenCV's below, on separate axes: on one scale the tracker's curve would be flat.
void draw(const std::vector<Curve>& curves, const std::string& path) {
  constexpr double kWidth = 720.0, kPanel = 220.0, kTop = 44.0, kStep = 290.0;
  app::SvgDocument svg(kWidth, kTop + 2.0 * kStep, "Bias over the fractions of a pixel");
  for (std::size_t which : {0U, 1U}) {
    double most = 0.0;
    for (const Curve& curve : curves) most = curve.kind == "aligned" ? most : std::max(most, curve.worst(which));
    const app::Box box{70.0, kTop + kStep * static_cast<double>(which), kWidth - 90.0, kPanel};
    app::PlotPanel panel(svg, box, {0.0, 1.0, false, "shift, px"}, {-1.1 * most, 1.1 * most, false, "mean error, px"});
    panel.draw_x_axis(true);
    panel.draw_y_axis(true);
    panel.draw_frame();
    for (const Curve& curve : curves) {
      if (curve.kind == "aligned") continue;
      std::vector<app::PlotPoint> points;
      for (std::size_t k = 0; k < kFractions; ++k) points.push_back({fraction(k), curve.px[which][k]});
      panel.curve(points, app::line_class(curve.kind == "dots" ? 1 : 0));
    }
    svg.text(box.x, box.y - 12.0,
             which == 0 ? "hovermodal: textures to 0.05 ... 0.35 cycles/px (blue), printed dots (orange)"
                        : "OpenCV: the same images",
             app::Anchor::kStart, "h");
  }
  std::ofstream(path) << svg.text_of();
}

}  // namespace

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  const int n_textures = argc > 1 ? std::atoi(argv[1]) : 2;
  if (n_textures < 1) {
    std::fprintf(stderr, "usage: tracking_bias [TEXTURES] [SEED] [PICTURE.svg]\n");
    return 2;
  }
  const std::vector<Curve> curves = measured(n_textures, static_cast<unsigned>(argc > 2 ? std::atoi(argv[2]) : 1));
  if (argc > 3) draw(curves, argv[3]);
}

#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

namespace test_support {

// A texture that is a sum of plane waves: evaluated at each pixel's position, never interpolated, so a shifted image is
// exact except for its rounding to 8 bits.
class AnalyticTexture {
 public:
  explicit AnalyticTexture(unsigned seed, double shortest_px = 8.0, double contrast = 30.0) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    constexpr int kWaves = 40;
    for (int i = 0; i < kWaves; ++i) {
      const double length_px = shortest_px * std::pow(5.0, unit(random));
      const double angle = std::numbers::pi * unit(random);
      const double k = 2.0 * std::numbers::pi / length_px;
      waves_.push_back({k * std::cos(angle), k * std::sin(angle), 2.0 * std::numbers::pi * unit(random)});
    }
    amplitude_ = contrast * std::sqrt(2.0 / kWaves);
  }

  [[nodiscard]] double at(double u, double v) const {
    double sum = 128.0;
    for (const Wave& w : waves_) sum += amplitude_ * std::sin(w.ku * u + w.kv * v + w.phase);
    return sum;
  }

  // The image after the scene moved by (du, dv) px, with white noise of `noise` grey levels.
  [[nodiscard]] cv::Mat image(int width, int height, double du, double dv, double noise = 0.0,
                              unsigned noise_seed = 0) const {
    cv::Mat gray(height, width, CV_8UC1);
    std::mt19937 random(noise_seed);
    std::normal_distribution<double> gaussian(0.0, 1.0);
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        const double value = at(u - du, v - dv) + (noise > 0.0 ? noise * gaussian(random) : 0.0);
        gray.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(value);
      }
    }
    return gray;
  }

 private:
  struct Wave {
    double ku, kv, phase;
  };
  std::vector<Wave> waves_;
  double amplitude_ = 0.0;
};

}  // namespace test_support

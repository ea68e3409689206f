#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "tests/support/tracker_pair.h"

namespace test_support {

// Exact except for its rounding: evaluated at each pixel's position, never interpolated. 200 plane waves, frequencies
// evenly
// distributed over a disk.
class WaveTexture {
 public:
  WaveTexture(unsigned seed, double most_cycles_per_px, double contrast) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    constexpr int kWaves = 200;
    constexpr double kTurn = 2.0 * std::numbers::pi;
    for (int i = 0; i < kWaves; ++i) {
      const double f = kTurn * most_cycles_per_px * std::sqrt(unit(random)), angle = kTurn * unit(random);
      waves_.push_back({f * std::cos(angle), f * std::sin(angle), kTurn * unit(random)});
    }
    amplitude_ = contrast * std::sqrt(2.0 / kWaves);
  }
  struct Value {
    double grey = 0.0, slope_u = 0.0, slope_v = 0.0;
  };
  [[nodiscard]] Value at(double u, double v) const {
    Value out;
    for (const Wave& w : waves_) {
      const double phase = w.ku * u + w.kv * v + w.phase, slope = amplitude_ * std::cos(phase);
      out.grey += amplitude_ * std::sin(phase);
      out.slope_u += slope * w.ku, out.slope_v += slope * w.kv;
    }
    return out;
  }
  // Moved by (du, dv), with white noise, rounded to 8 bits.
  [[nodiscard]] cv::Mat image(double du, double dv, double noise, unsigned seed) const {
    std::vector<double> grey(std::size_t{kPairWidth} * kPairHeight, 128.0);
    for (const Wave& w : waves_) {
      const double turn_re = std::cos(w.ku), turn_im = std::sin(w.ku);
      for (int v = 0; v < kPairHeight; ++v) {
        const double phase = w.kv * (v - dv) + w.phase - w.ku * du;
        double re = std::cos(phase), im = std::sin(phase);
        for (int u = 0; u < kPairWidth; ++u) {
          grey[static_cast<std::size_t>(v * kPairWidth + u)] += amplitude_ * im;
          const double next = re * turn_re - im * turn_im;
          im = im * turn_re + re * turn_im, re = next;
        }
      }
    }
    cv::Mat out(kPairHeight, kPairWidth, CV_8UC1);
    std::mt19937 random(seed);
    std::normal_distribution<double> gaussian(0.0, 1.0);
    for (std::size_t i = 0; i < grey.size(); ++i)
      out.data[i] = cv::saturate_cast<std::uint8_t>(grey[i] + (noise > 0.0 ? noise * gaussian(random) : 0.0));
    return out;
  }

 private:
  struct Wave {
    double ku, kv, phase;
  };
  std::vector<Wave> waves_;
  double amplitude_ = 0.0;
};

}  // namespace test_support

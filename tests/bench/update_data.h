#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <numbers>
#include <vector>

#include "core/simulation/random_stream.h"
#include "core/spectrum/welch_cpsd.h"

// What the benches of an identification's update share: motion, processor time.
namespace bench {

inline constexpr double kRateHz = 30.0;

// Sums of modes of a cantilever-like frame under white force, with 1 % of noise: by sample, n_channels side by side.
inline std::vector<double> make_motion(int n_channels, int n_samples, std::uint64_t seed) {
  core::simulation::RandomStream random(seed, "identification_speed");
  std::vector<double> motion(static_cast<std::size_t>(n_channels) * static_cast<std::size_t>(n_samples));
  for (double& x : motion) x = 0.01 * random.gaussian();
  for (int m = 1; m <= n_channels; ++m) {
    const double angle = std::numbers::pi * (2 * m - 1) / (2 * n_channels + 1) / 2.0;
    const double w = 2.0 * std::numbers::pi * 13.0 * std::sin(angle) / kRateHz;
    const double decay = std::exp(-0.01 * w);
    double before = 0.0, last = 0.0;
    for (int t = 0; t < n_samples; ++t) {
      const double now = 2.0 * decay * std::cos(w) * last - decay * decay * before + w * w / m * random.gaussian();
      before = last;
      last = now;
      for (int c = 0; c < n_channels; ++c) {
        motion[static_cast<std::size_t>(t * n_channels + c)] += now * std::sin(2.0 * angle * (c + 1));
      }
    }
  }
  return motion;
}

inline double cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

inline void push(core::WelchCpsd& welch, const std::vector<double>& motion, std::size_t n_channels, std::size_t begin,
                 std::size_t end) {
  const std::vector<std::uint8_t> seen(n_channels, 1);
  for (std::size_t t = begin; t < end; ++t) welch.push({motion.data() + t * n_channels, n_channels}, seen);
}

}  // namespace bench

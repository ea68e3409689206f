#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/simulation/presets.h"
#include "core/simulation/scene.h"
#include "core/simulation/structure/structure_response.h"
#include "core/spectrum/welch_cpsd.h"
#include "core/types/displacement.h"

namespace test_support {

// The paper's six-storey frame under white base motion: channel 0 is the base, channel i floor i, each sampled at its
// own row delay, with white noise. No camera, no tracking.
struct SimulatedStructure {
  double rate_hz = 60.0;
  double duration_s = 300.0;
  double noise_mm = 0.02;
  double delay_step_s = 0.0;  // the channels' delays are 0, 1, 2, ... steps, the roof first
  int segment = 1024;
  std::uint64_t seed = 1;
  core::simulation::Scene scene = core::simulation::make_paper_scene(1, 300.0);
  std::vector<core::simulation::TrueMode> modes = core::simulation::modes_of(scene.structure);

  [[nodiscard]] int n_channels() const { return scene.n_bodies(); }

  [[nodiscard]] std::vector<core::ChannelInfo> channels() const {
    std::vector<core::ChannelInfo> list;
    for (int c = 0; c < n_channels(); ++c) {
      core::ChannelInfo info;
      info.region = static_cast<std::uint16_t>(c);
      info.name = c == 0 ? "base" : "floor" + std::to_string(c);
      info.row_delay_s = delay_step_s * (n_channels() - 1 - c);
      info.is_base = c == 0;
      list.push_back(info);
    }
    return list;
  }

  [[nodiscard]] core::CpsdSums spectra() const {
    const core::simulation::StructureResponse response(scene.structure, scene.excitation, seed, duration_s + 1.0);
    core::WelchConfig config;
    config.n_channels = n_channels();
    config.segment = segment;
    config.rate_hz = rate_hz;
    core::WelchCpsd welch(config);
    std::mt19937_64 random(seed);
    std::normal_distribution<double> gaussian(0.0, noise_mm);
    std::vector<double> value(static_cast<std::size_t>(n_channels()));
    const std::vector<std::uint8_t> seen(value.size(), 1);
    const std::vector<core::ChannelInfo> list = channels();
    const auto n = static_cast<int>(duration_s * rate_hz);
    for (int k = 0; k < n; ++k) {
      for (std::size_t c = 0; c < value.size(); ++c) {
        value[c] = response.displacement_mm(static_cast<int>(c), k / rate_hz + list[c].row_delay_s) + gaussian(random);
      }
      welch.push(value, seen);
    }
    welch.flush();
    return welch.sums();
  }

  [[nodiscard]] double frequency_hz(std::size_t mode) const { return modes[mode].frequency_hz; }
  // Least possible scatter (core/identification/METHOD.md): sqrt(zeta / (2 pi f T)) of the frequency.
  [[nodiscard]] double frequency_scatter_hz(std::size_t mode) const {
    const double f = modes[mode].frequency_hz;
    return f * std::sqrt(modes[mode].damping_ratio / (2.0 * 3.14159265358979 * f * duration_s));
  }
  [[nodiscard]] double damping_scatter(std::size_t mode) const {
    const double zeta = modes[mode].damping_ratio;
    return zeta / std::sqrt(2.0 * 3.14159265358979 * zeta * modes[mode].frequency_hz * duration_s);
  }
};

}  // namespace test_support

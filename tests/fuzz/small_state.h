#pragma once

#include <utility>

#include "core/identification/mode_tracker.h"
#include "core/spectrum/welch_cpsd.h"
#include "firmware_app/chain/state/run_state.h"

namespace tests::fuzz {

// A run so small that its state has a few kilobytes: used by the checkpoint target and its corpus.

inline constexpr double kRate_hz = 25.0;
inline constexpr std::size_t kChannels = 2, kRegions = 2;
inline constexpr std::uint64_t kConfigHash = 7;

[[nodiscard]] inline core::WelchConfig small_welch() {
  core::WelchConfig config;
  config.n_channels = static_cast<int>(kChannels);
  config.segment = 8;
  config.rate_hz = kRate_hz;
  config.n_blocks = 4;
  return config;
}

[[nodiscard]] inline core::ModeTracker small_tracker() { return core::ModeTracker({.row_delay_s = {0.0, 0.001}}); }

[[nodiscard]] inline core::ModalEstimate small_estimate(int k) {
  core::ModalEstimate estimate;
  estimate.number = static_cast<std::uint64_t>(k);
  estimate.rate_hz = kRate_hz;
  estimate.duration_s = 60.0 + 20.0 * k;
  estimate.n_samples = static_cast<std::uint64_t>(estimate.duration_s * kRate_hz);
  estimate.status = "ok";
  core::Mode mode;
  mode.frequency_hz = mode.apparent_hz = 2.0 + 0.001 * k;
  mode.damping_ratio = 0.01;
  mode.verdict = core::Verdict::kStructural;
  mode.shape = {0.3, 1.0};
  estimate.modes = {mode};
  return estimate;
}

[[nodiscard]] inline core::CameraInfo small_camera() {
  core::CameraInfo camera;
  camera.width_px = 8;
  camera.height_px = 6;
  camera.rate_hz = kRate_hz;
  return camera;
}

[[nodiscard]] inline app::RunState small_state(std::vector<std::uint8_t> spectrum, std::vector<std::uint8_t> modes) {
  app::RunState state;
  state.config_hash = kConfigHash;
  state.rate_hz = kRate_hz;
  state.scale_mm_per_px = 1.0;
  state.channels.resize(kChannels);
  state.channels[0].name = "base", state.channels[0].is_base = true;
  state.channels[1].name = "roof", state.channels[1].region = 1;
  state.spectrum = std::move(spectrum), state.modes = std::move(modes);
  return state;
}

}  // namespace tests::fuzz

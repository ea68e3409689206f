#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/types/closure_report.h"
#include "core/types/cpsd.h"
#include "core/types/displacement.h"
#include "core/types/health.h"
#include "core/types/modal_estimate.h"
#include "core/types/preview.h"
#include "core/types/track.h"

namespace tests {

// Plausible contents of every kind of message; `n` makes them differ from one another.

inline std::vector<core::ChannelInfo> sample_channels(std::size_t n_channels) {
  std::vector<core::ChannelInfo> out(n_channels);
  for (std::size_t i = 0; i < n_channels; ++i) {
    out[i].region = static_cast<std::uint16_t>(i);
    out[i].name = "floor_" + std::to_string(i + 1) + ".u";
    out[i].row_delay_s = 0.001 * static_cast<double>(i);
  }
  return out;
}

inline core::Mode sample_mode(std::size_t n_channels, double frequency_hz) {
  core::Mode mode;
  mode.frequency_hz = frequency_hz;
  mode.frequency_std_hz = 0.01;
  mode.apparent_hz = frequency_hz;
  mode.fold_n = 0;
  mode.damping_ratio = 0.01;
  mode.damping_std = 0.002;
  mode.mpc = 0.98;
  mode.presence = 0.9;
  mode.verdict = core::Verdict::kStructural;
  mode.history = core::ModeHistory{3, 4, 1, 20.0, 0, 0.0005, 0.0001, true, 600.0};
  for (std::size_t i = 0; i < n_channels; ++i) {
    const double x = static_cast<double>(i + 1) / static_cast<double>(n_channels);
    mode.shape.emplace_back(i % 3 == 1 ? -x : x, 0.01 * x);
    mode.shape_std.push_back(0.02);
  }
  return mode;
}

inline core::ModalEstimate sample_estimate(std::size_t n_channels, std::size_t n_modes, std::uint64_t n = 0) {
  core::ModalEstimate out;
  out.number = n;
  out.n_samples = 1000 * (n + 1);
  out.n_segments = 9;
  out.t_stream_ns = static_cast<std::int64_t>(out.n_samples) * 40'000'000;
  out.rate_hz = 25.0;
  out.duration_s = 40.0;
  out.model_order = 12;
  out.status = "ok";
  for (std::size_t i = 0; i < n_modes; ++i) {
    out.modes.push_back(sample_mode(n_channels, 1.5 * static_cast<double>(i + 1)));
  }
  return out;
}

inline core::DisplacementSample sample_displacement(std::size_t n_channels, std::uint64_t n) {
  core::DisplacementSample out;
  out.sequence = n;
  out.t_start_ns = static_cast<std::int64_t>(n) * 40'000'000;
  out.scale_mm_per_px = 0.95;
  for (std::size_t i = 0; i < n_channels; ++i) {
    out.value_mm.push_back(static_cast<double>((n * (i + 1)) % 7) - 3.0);
    out.sigma_mm.push_back(0.02);
    out.seen.push_back(1);
    out.n_points.push_back(20);
  }
  return out;
}

inline core::TrackFrame sample_tracks(std::size_t n_points, std::uint64_t n) {
  core::TrackFrame out;
  out.sequence = n;
  out.t_start_ns = static_cast<std::int64_t>(n) * 40'000'000;
  for (std::size_t i = 0; i < n_points; ++i) {
    out.points.push_back({100.0 + static_cast<double>(i), 200.25, 0.05, static_cast<std::uint32_t>(i),
                          static_cast<std::uint16_t>(i % 4), i % 5 != 0, i % 7 != 0});
  }
  return out;
}

inline core::CpsdSums sample_sums(int n_channels, int n_fft) {
  core::CpsdSums out;
  out.n_channels = n_channels;
  out.n_fft = n_fft;
  out.rate_hz = 25.0;
  out.n_segments = 4, out.weight = {4.0, 4.0};
  out.n_samples = 1000;
  out.window_power = 0.375 * n_fft;
  out.data_sum.assign(static_cast<std::size_t>(out.n_bins()) * static_cast<std::size_t>(out.n_pairs()), {2.0, 0.0});
  out.mask_sum = out.data_sum;
  return out;
}

inline core::closure::ClosureReport sample_closure(std::size_t n_steps, std::uint64_t n = 0) {
  core::closure::ClosureReport out;
  out.number = n;
  out.first_sequence = 100 * n;
  out.last_sequence = 100 * n + 1499;
  out.t_stream_ns = static_cast<std::int64_t>(out.last_sequence) * 40'000'000;
  out.duration_s = 60.0;
  out.took_s = 1.5;
  out.result.level = "observation";
  out.result.unit = "px";
  out.result.baseline_rms = 0.0433;
  out.result.residual_rms = 0.0312;
  out.result.noise_floor = 0.0311;
  out.result.unexplained_fraction = 0.01;
  out.result.unexplained = "nothing: noise";
  out.result.stop_reason = "noise";
  out.changes = {"from frame 1875 on taken out, readout time: readout = 22.5 +- 0.12 ms"};
  out.in_force = {"readout time: readout = 22.5 +- 0.12 ms, from frame 1875 on"};
  for (std::size_t i = 0; i < n_steps; ++i) {
    core::closure::ClosureStep step;
    step.effect = i % 2 == 0 ? "readout time" : "latent " + std::to_string(i);
    step.kind = i % 2 == 0 ? core::closure::EffectKind::kNamed : core::closure::EffectKind::kLatent;
    step.parameters = {{"readout", "ms", 22.5, 0.125}, {"offset", "1", 3.0, {}}};
    step.meaning = i % 2 == 0 ? "" : "in region roof, along u, strongest at 3.2 Hz";
    step.heldout_before = 0.0433, step.heldout_after = 0.0312;
    step.score = 1234.0, step.threshold = 5.0;
    out.result.steps.push_back(step);
  }
  return out;
}

inline core::Preview sample_preview(std::uint64_t n) {
  core::Preview out;
  out.sequence = n;
  out.t_start_ns = static_cast<std::int64_t>(n) * 40'000'000;
  out.width_px = 64, out.height_px = 36, out.reduction = 30;
  out.image_width_px = 1920, out.image_height_px = 1080;
  for (int i = 0; i < 64 * 36; ++i) out.pixels.push_back(static_cast<std::uint8_t>(i % 251));
  out.points = sample_tracks(12, n).points;
  out.shifts = {{1.5, -0.5, 6}, {}};
  return out;
}

inline core::Health sample_health(const std::string& state, std::uint64_t n) {
  core::Health out;
  out.t_stream_ns = static_cast<std::int64_t>(n) * 1'000'000'000;
  out.rate_hz = 25.0;
  out.frames_in = 25 * n;
  out.frames_processed = 25 * n;
  out.points_tracked = 58;
  out.points_total = 60;
  out.state = state;
  out.frame_latency = {25 * n, 5, 7, 8, 9};
  out.host.cpu_temperature_c = 61.5;
  out.host.disk_left_bytes = 5'000'000'000;
  out.warnings = {"real-time priority refused"};
  for (const char* name : {"capture", "tracking", "spectrum", "identification", "publish"}) {
    core::StageHealth stage;
    stage.name = name;
    stage.n_in = stage.n_out = 25 * n;
    stage.cpu_ns = 2'000'000 * n;
    stage.step = {n, 1'000'000, 2'000'000, 2'500'000, 3'000'000};
    stage.queue_slots = 8;
    out.stages.push_back(stage);
  }
  out.regions = {{"roof", core::RegionState::kSearching, 0, 30, 7, 0},
                 {"base", core::RegionState::kMeasuring, 29, 30, 0, 0}};
  return out;
}

}  // namespace tests

#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <utility>

#include "firmware_app/report/pictures/pictures.h"
#include "firmware_app/report/run_history.h"

namespace app {

// Synthetic data of a run: channels on a vertical line, three modes of which the last is aliased.
struct RunData {
  core::Frame frame;
  core::TrackFrame keyframe;
  core::CpsdSums spectrum;
  core::ModalEstimate estimate;
  std::unique_ptr<RunHistory> history;
  RunFacts facts;
  PictureInputs inputs;
};

inline void add_channel(RunData& run, std::size_t i, std::size_t n) {
  core::Region region;
  region.name = fmt::format("floor{}", i);
  const double step = 1000.0 / static_cast<double>(n);
  region.u_px = 800.0, region.v_px = 40.0 + step * static_cast<double>(n - 1 - i);
  region.width_px = 300.0, region.height_px = std::min(40.0, step);
  if (i == 0) region.role = core::RegionRole::kBase;
  run.inputs.regions.push_back(region);
  core::ChannelInfo channel;
  channel.name = region.name, channel.region = static_cast<std::uint16_t>(i), channel.is_base = i == 0;
  run.inputs.channels.push_back(channel);
  for (std::uint32_t k = 0; k < 20; ++k) {
    run.keyframe.points.push_back({805.0 + 15.0 * k, region.v_px + std::fmod(7.3 * k, region.height_px), 0.05, k,
                                   static_cast<std::uint16_t>(i), k % 7 != 6, true});
  }
}

// Noise: the worst case for compression.
inline void fill_frame(RunData& run, int width_px, int height_px) {
  run.frame.width_px = width_px, run.frame.height_px = height_px;
  run.frame.pixels.resize(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px));
  std::mt19937 random(1);
  for (std::uint8_t& pixel : run.frame.pixels) pixel = static_cast<std::uint8_t>(random() % 256);
}

inline void fill_spectrum(RunData& run, std::size_t n) {
  core::CpsdSums& sums = run.spectrum;
  sums.n_channels = static_cast<int>(n), sums.n_fft = 4096, sums.rate_hz = 25.0, sums.n_segments = 8,
  sums.weight = {8.0, 8.0}, sums.window_power = 768.0;
  sums.data_sum.assign(static_cast<std::size_t>(sums.n_bins()) * static_cast<std::size_t>(sums.n_pairs()), 0.0);
  std::mt19937 random(1);
  for (int k = 0; k < sums.n_bins(); ++k) {
    for (int c = 0; c < sums.n_channels; ++c) {
      double value = 1.0 + static_cast<double>(random() % 1000) / 1000.0;
      for (const double f0 : {1.657, 5.04, 12.07}) {
        value += 100.0 * (c + 1) / (0.01 + std::pow(k * sums.rate_hz / sums.n_fft - f0, 2.0));
      }
      const auto at = static_cast<std::size_t>(k * sums.n_pairs() + core::CpsdSums::pair_index(c, c, sums.n_channels));
      sums.data_sum[at] = value;
    }
  }
}

inline core::Mode made_up_mode(double frequency_hz, double apparent_hz, std::size_t n_channels, core::Verdict verdict) {
  core::Mode out;
  out.frequency_hz = frequency_hz, out.apparent_hz = apparent_hz, out.damping_ratio = 0.0102, out.mpc = 0.998;
  out.frequency_std_hz = 0.003, out.damping_std = 0.001;
  out.fold_n = frequency_hz > 12.5 ? 1 : 0;
  for (std::size_t i = 0; i < n_channels; ++i) {
    const double along = n_channels > 1 ? static_cast<double>(i) / static_cast<double>(n_channels - 1) : 1.0;
    out.shape.emplace_back(std::sin(along * std::numbers::pi * (0.5 + frequency_hz / 4.0)), 0.01);
    out.shape_std.push_back(0.05);
  }
  out.verdict = verdict;
  return out;
}

// Every 10th sample of a channel is missing, 20 frames in a row, and all of the last channel of three or more; a
// fifth of the points is lost between frames 200 and 230.
inline void fill_history(RunData& run, std::size_t n_samples) {
  const std::size_t n = run.inputs.channels.size();
  run.history = std::make_unique<RunHistory>(25.0, n, run.inputs.regions.size());
  core::DisplacementSample sample;
  sample.value_mm.resize(n), sample.seen.resize(n);
  core::TrackFrame tracks = run.keyframe;
  for (std::size_t k = 0; k < n_samples; ++k) {
    if (k >= 100 && k < 120) continue;
    const double t = static_cast<double>(k) / 25.0;
    tracks.t_start_ns = sample.t_start_ns = 1'000'000'000'000 + static_cast<std::int64_t>(k) * 40'000'000;
    sample.scale_mm_per_px = 0.95 + 0.02 * std::sin(0.7 * t);
    for (std::size_t c = 0; c < n; ++c) {
      sample.seen[c] = (k + c) % 10 == 9 || (c >= 2 && c + 1 == n) ? 0 : 1;
      sample.value_mm[c] = 20.0 * std::sin(0.3 * t) + static_cast<double>(c + 1) * std::sin(10.4 * t);
    }
    for (core::TrackPoint& point : tracks.points) point.seen = k < 200 || k > 230 || point.id % 5 != 0;
    run.history->add(tracks);
    run.history->add(sample);
  }
  run.inputs.history = run.history.get();
}

// Eight estimates that converge to the last one; the second mode drifts.
inline void fill_estimates(RunData& run) {
  for (std::size_t i = 0; i < run.estimate.modes.size(); ++i) {
    run.estimate.modes[i].history = core::ModeHistory{
        static_cast<std::uint32_t>(i + 1), 7, 0, 8.0, i == 2 ? 1U : 0U, 1e-4, 2e-5, i == 1, i == 0 ? 240.0 : 0.0};
  }
  for (std::uint64_t k = 1; k <= 8; ++k) {
    core::ModalEstimate estimate = run.estimate;
    estimate.n_samples = run.estimate.n_samples * k / 8;
    for (core::Mode& mode : estimate.modes) {
      const double away = std::sqrt(8.0 / static_cast<double>(k) - 1.0);
      mode.frequency_hz *= 1.0 + 0.002 * away;
      mode.damping_ratio *= 1.0 - 0.1 * away;
      if (k == 1) mode.history.reset();
    }
    run.history->add(estimate);
  }
}

// Poles of 15 orders: three modes in all of them, and an unassigned one in each.
inline void fill_poles(RunData& run) {
  for (int order = 16; order <= 44; order += 2) {
    for (std::size_t i = 0; i < run.estimate.modes.size(); ++i) {
      const core::Mode& mode = run.estimate.modes[i];
      run.estimate.poles.push_back({order, mode.apparent_hz, mode.frequency_hz, 0.01, 0.99, static_cast<int>(i)});
    }
    run.estimate.poles.push_back({order, 0.2 * order, 0.2 * order, 0.05, 0.4, -1});
  }
}

inline void fill_health(RunData& run, std::size_t n_samples) {
  core::Health& health = run.facts.health;
  health.state = "running";
  health.frames_in = health.frames_processed = n_samples;
  health.frames_missing = 20;
  core::StageHealth tracking;
  tracking.name = "tracking";
  tracking.n_in = tracking.n_out = n_samples;
  tracking.busy_ns = 1'000'000 * n_samples;
  tracking.step = {n_samples, 1'000'000, 2'000'000, 5'000'000, 7'654'321};
  tracking.queue_slots = 8;
  health.stages.push_back(tracking);
}

// A complete run: channels on a vertical line, three modes of which the last is aliased, and all contents of its page.
inline void make_run(RunData& run, std::size_t n_channels, std::size_t n_samples) {
  for (std::size_t i = 0; i < n_channels; ++i) add_channel(run, i, n_channels);
  fill_frame(run, 640, 360);
  fill_spectrum(run, n_channels);
  run.estimate.status = "ok";
  run.estimate.rate_hz = 25.0, run.estimate.duration_s = static_cast<double>(n_samples) / 25.0;
  run.estimate.n_samples = n_samples, run.estimate.n_segments = 8;
  for (const auto& [true_hz, apparent_hz] : {std::pair{1.657, 1.657}, {5.04, 5.04}, {12.93, 12.07}}) {
    run.estimate.modes.push_back(made_up_mode(true_hz, apparent_hz, n_channels, core::Verdict::kStructural));
  }
  run.estimate.rejected.push_back(made_up_mode(0.3, 0.3, n_channels, core::Verdict::kCameraMotion));
  run.estimate.rejected.push_back(made_up_mode(7.0, 7.0, n_channels, core::Verdict::kInputPeak));
  fill_poles(run);
  fill_history(run, n_samples);
  fill_estimates(run);
  fill_health(run, n_samples);
  run.inputs.first_frame = &run.frame, run.inputs.keyframe = &run.keyframe;
  run.inputs.spectrum = &run.spectrum, run.inputs.estimate = &run.estimate;
  run.inputs.unit = "mm", run.inputs.max_frequency_hz = 37.0;
}

}  // namespace app

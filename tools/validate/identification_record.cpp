#include "tools/validate/identification_record.h"

#include <algorithm>
#include <cmath>

#include "core/simulation/channel_generator.h"
#include "core/simulation/random_stream.h"
#include "core/spectrum/welch_cpsd.h"

namespace tools {
namespace {

using core::simulation::ChannelGenerator;
using core::simulation::SceneMotion;

// Samples of every frame slot; slots without a frame stay unseen. fill(frame, k): channel values of one frame.
template <class Fill>
Record gather(const SceneMotion& motion, const std::vector<core::ChannelInfo>& channels, Fill fill) {
  Record record;
  record.rate_hz = motion.scene().camera.rate_hz;
  record.channels = channels;
  const auto samples = static_cast<std::size_t>(motion.scene().n_frames());
  record.value_mm.assign(samples * channels.size(), 0.0);
  record.seen.assign(samples * channels.size(), 0);
  core::simulation::FrameTiming timing(motion.scene());
  core::simulation::DeliveredFrame frame;
  while (timing.next(frame)) {
    const std::size_t at = static_cast<std::size_t>(frame.number) * channels.size();
    fill(frame, record.value_mm.data() + at, record.seen.data() + at);
  }
  return record;
}

// Noise of each channel, unequal like that of points. Empty if all have the scene's own.
std::vector<double> unequal_noise_mm(const core::simulation::Scene& scene, std::size_t n_channels) {
  std::vector<double> noise_mm;
  const double spread = scene.tracks.noise_spread;
  core::simulation::RandomStream stream(scene.seed, "channel_noise_spread");
  for (std::size_t c = 0; c < n_channels && spread > 0.0; ++c) {
    noise_mm.push_back(scene.channels.noise_mm * std::exp(spread * stream.gaussian() - spread * spread));
  }
  return noise_mm;
}

core::simulation::Scene without_channel_noise(core::simulation::Scene scene) {
  scene.channels.noise_mm = 0.0;
  return scene;
}

std::vector<std::size_t> all_but_base(const std::vector<core::ChannelInfo>& channels) {
  std::vector<std::size_t> keep;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (!channels[c].is_base) keep.push_back(c);
  }
  return keep;
}

}  // namespace

Record select_channels(const Record& record, const std::vector<std::size_t>& keep) {
  Record chosen;
  chosen.rate_hz = record.rate_hz;
  for (const std::size_t c : keep) chosen.channels.push_back(record.channels[c]);
  const std::size_t n = record.channels.size();
  for (std::size_t k = 0; k < record.n_samples(); ++k) {
    for (const std::size_t c : keep) {
      chosen.value_mm.push_back(record.value_mm[k * n + c]);
      chosen.seen.push_back(record.seen[k * n + c]);
    }
  }
  return chosen;
}

Record structure_record(const core::simulation::Scene& scene, bool with_base) {
  const bool is_unequal = scene.tracks.noise_spread > 0.0;
  const SceneMotion motion(is_unequal ? without_channel_noise(scene) : scene);
  const ChannelGenerator generator(motion, scene.camera.readout_s);
  const std::vector<double> noise_mm = unequal_noise_mm(scene, generator.channels().size());
  core::DisplacementSample sample = generator.sample_prototype();
  const Record record = gather(motion, generator.channels(), [&](const auto& frame, double* value, auto* seen) {
    generator.generate(frame, sample);
    core::simulation::RandomStream noise(scene.seed, "channel_noise", frame.number);
    for (std::size_t c = 0; c < noise_mm.size(); ++c) sample.value_mm[c] += noise_mm[c] * noise.gaussian();
    std::copy(sample.value_mm.begin(), sample.value_mm.end(), value);
    std::copy(sample.seen.begin(), sample.seen.end(), seen);
  });
  return with_base ? record : select_channels(record, all_but_base(record.channels));
}

Record image_record(const core::simulation::Scene& scene, bool with_base) {
  const SceneMotion motion(scene);
  const ChannelGenerator generator(motion, scene.camera.readout_s);  // its channels and their delays
  std::vector<int> bodies;
  for (const auto& [body, region] : tracking_regions(motion)) {
    if (body != core::simulation::kBackgroundBody) bodies.push_back(body);
  }
  std::vector<double> start_px, noise_mm = unequal_noise_mm(scene, bodies.size());
  if (noise_mm.empty()) noise_mm.assign(bodies.size(), scene.channels.noise_mm);
  for (const int body : bodies) start_px.push_back(motion.see(body, {0.0, 0.0}, 0.0).u_px);
  const Record record = gather(motion, generator.channels(), [&](const auto& frame, double* value, auto* seen) {
    core::simulation::RandomStream noise(scene.seed, "channel_noise", frame.number);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      value[i] = motion.see(bodies[i], {0.0, 0.0}, frame.t_s).u_px - start_px[i] + noise_mm[i] * noise.gaussian();
      seen[i] = 1;
    }
  });
  return with_base ? record : select_channels(record, all_but_base(record.channels));
}

core::CpsdSums spectra(const Record& record, bool bridge_losses) {
  core::WelchConfig config;
  const std::size_t n = record.channels.size();
  config.n_channels = static_cast<int>(n);
  config.segment = kSegment;
  config.bridge_losses = bridge_losses;
  config.rate_hz = record.rate_hz;
  core::WelchCpsd welch(config);
  for (std::size_t k = 0; k < record.n_samples(); ++k) {
    welch.push({record.value_mm.data() + k * n, n}, {record.seen.data() + k * n, n});
  }
  welch.flush();
  return welch.sums();
}

core::CpsdSums without_window_correction(core::CpsdSums sums) {
  const auto pairs = static_cast<std::size_t>(sums.n_pairs());
  const auto bins = static_cast<std::size_t>(sums.n_bins());
  // The mask's correlation at lag 0 is the mean of its spectrum over all bins, both halves. A spectrum that is zero
  // except for bin 0 has the same value at every lag.
  for (std::size_t pair = 0; pair < pairs; ++pair) {
    double whole = sums.mask_sum[pair].real() + sums.mask_sum[(bins - 1) * pairs + pair].real();
    for (std::size_t k = 1; k + 1 < bins; ++k) whole += 2.0 * sums.mask_sum[k * pairs + pair].real();
    for (std::size_t k = 0; k < bins; ++k) sums.mask_sum[k * pairs + pair] = 0.0;
    sums.mask_sum[pair] = whole;
  }
  return sums;
}

core::IdentifierConfig identifier_config(double max_frequency_hz) {
  core::IdentifierConfig config;
  config.max_frequency_hz = max_frequency_hz;
  config.n_differences = -1;
  return config;
}

core::ModalEstimate identify_record(const Record& record, double max_frequency_hz, bool bridge_losses) {
  return core::Identifier(identifier_config(max_frequency_hz), record.channels)
      .identify(spectra(record, bridge_losses));
}

}  // namespace tools

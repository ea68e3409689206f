#include "tools/validate/closure_series_cases.h"

#include <algorithm>
#include <cmath>

#include "core/simulation/channel_generator.h"
#include "tools/validate/drawn_scene.h"

namespace tools {
namespace {

using core::simulation::Scene;

constexpr double kCaseDuration_s = 120.0;

// Of a frame: larger jitter would exchange neighbours, and the simulator refuses it.
void set_jitter(Scene& s, double rms_s) { s.timing.jitter_rms_s = std::min(rms_s, 0.2 / s.camera.rate_hz); }

double jitter_ms(const Scene&, const CountedSeries& series) { return series.jitter_rms_ms; }

}  // namespace

CountedSeries counted_series(const Scene& scene) {
  const core::simulation::SceneMotion motion(scene);
  const core::simulation::ChannelGenerator generator(motion, scene.camera.readout_s);
  core::DisplacementSample sample = generator.sample_prototype();
  core::simulation::FrameTiming timing(scene);
  std::vector<std::vector<double>> rows;
  CountedSeries out;
  double squares = 0.0;
  std::uint64_t last = 0;
  for (core::simulation::DeliveredFrame frame; timing.next(frame);) {
    generator.generate(frame, sample);
    if (!rows.empty() && frame.number == last) ++out.n_twice;
    if (frame.number > last) out.n_lost += static_cast<int>(frame.number - last) - 1;
    last = frame.number;
    rows.push_back(sample.value_mm);
    squares += std::pow(1e3 * (frame.t_s - static_cast<double>(frame.number) / scene.camera.rate_hz), 2);
  }
  out.n_lost -= out.n_twice;  // a repeated picture replaces its own frame
  out.jitter_rms_ms = std::sqrt(squares / static_cast<double>(rows.size()));
  out.record.rate_hz = scene.camera.rate_hz;
  const auto& channels = generator.channels();
  const auto n = static_cast<Eigen::Index>(rows.size());
  const auto n_base = std::count_if(channels.begin(), channels.end(), [](const auto& c) { return c.is_base; });
  out.record.value.resize(n, static_cast<Eigen::Index>(channels.size()) - n_base);
  out.record.input.resize(n, n_base);
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::Index value = 0, input = 0;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const double v = rows[static_cast<std::size_t>(k)][c];
      (channels[c].is_base ? out.record.input(k, input++) : out.record.value(k, value++)) = v;
    }
  }
  return out;
}

Scene series_scene(std::uint64_t seed, bool wind) {
  Scene scene = draw_scene(seed, kCaseDuration_s).scene;
  scene.timing.stamps_tell = false;
  if (wind) scene.excitation.base = 0.0, scene.excitation.forces = 1.0;
  return scene;
}

const std::vector<SeriesCase>& series_cases() {
  static const std::vector<SeriesCase> all{
      {"frequency_drift", "4 %",
       [](Scene& s) { s.change.frequency_drift = 0.04 * Draw(s.seed, "frequency_drift").sign(); },
       [](const Scene& s, const CountedSeries&) { return 100.0 * s.change.frequency_drift; }},
      {"softening", "3 %", [](Scene& s) { s.change.softening = 0.03 * Draw(s.seed, "softening").sign(); },
       [](const Scene& s, const CountedSeries&) { return -100.0 * s.change.softening; }},
      {"time_stamp_jitter", "1 ms", [](Scene& s) { set_jitter(s, 1e-3); }, jitter_ms},
      {"time_stamp_jitter", "4 ms", [](Scene& s) { set_jitter(s, 4e-3); }, jitter_ms},
      {"dropped_frames", "1 %", [](Scene& s) { s.timing.drop_probability = 0.01; },
       [](const Scene&, const CountedSeries& series) { return static_cast<double>(series.n_lost); }},
      {"duplicated_frames", "1 %", [](Scene& s) { s.timing.duplicate_probability = 0.01; },
       [](const Scene&, const CountedSeries& series) { return static_cast<double>(series.n_twice); }}};
  return all;
}

}  // namespace tools

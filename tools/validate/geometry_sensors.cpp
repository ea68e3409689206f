#include "tools/validate/geometry_sensors.h"

#include <fmt/format.h>

#include <cmath>

#include "core/simulation/random_stream.h"
#include "core/simulation/structure/structure_response.h"
#include "tools/validate/resample.h"

namespace tools {
namespace {

constexpr double kAccelerometer_hz = 1024.0, kAccelerometerNoise_mm_s2 = 5.0;
constexpr double kFrameRate_hz = 60.0, kResampled_hz = 25.0;

}  // namespace

app::ChannelSeries accelerations(const core::simulation::Scene& scene) {
  const core::simulation::StructureResponse response(scene.structure, scene.excitation, scene.seed, scene.duration_s,
                                                     2.0 * kAccelerometer_hz);
  app::ChannelSeries series;
  series.rate_hz = kAccelerometer_hz;
  series.unit = "mm/s2";
  const double step_s = 1.0 / kAccelerometer_hz;
  const auto n = static_cast<std::size_t>(scene.duration_s * kAccelerometer_hz);
  for (int body = 1; body < response.n_bodies(); ++body) {
    core::ChannelInfo channel;
    channel.region = static_cast<std::uint16_t>(body - 1);
    channel.name = scene.plates[static_cast<std::size_t>(body)].name;
    channel.n_integrations = 2;
    series.channels.push_back(channel);
    core::simulation::RandomStream noise(scene.seed, "accelerometer", static_cast<std::uint64_t>(body));
    std::vector<double> values;
    for (std::size_t k = 0; k < n; ++k) {
      const double t_s = static_cast<double>(k) * step_s;
      const double bend = response.displacement_mm(body, t_s + step_s) - 2.0 * response.displacement_mm(body, t_s) +
                          response.displacement_mm(body, t_s - step_s);
      values.push_back(bend / (step_s * step_s) + kAccelerometerNoise_mm_s2 * noise.gaussian());
    }
    series.value.push_back(std::move(values));
  }
  return series;
}

StationaryRecord stationary_camera(std::uint64_t seed, double duration_s) {
  FlightSetup setup;
  setup.scene = fmt::format(
      "preset: paper\ncamera: {{rate_hz: {}, readout_ms: 11.7, alpha_px: 1050, position_mm: [0, 0, 1000]}}\n"
      "hover: {{x_rms_mm: 0, y_rms_mm: 0, z_rms_mm: 0}}\n",
      kFrameRate_hz);
  setup.configuration = {"identification.period=10000"};
  const SimulateJob job = flight_job(setup, seed, duration_s, {});
  std::vector<std::vector<double>> values;
  const AnalysedFlight result = analyse_flight(job, setup, {{"stationary", {"scale.adaptive=false"}}},
                                               [&](std::size_t, const core::DisplacementSample& sample, const auto&) {
                                                 values.resize(sample.value_mm.size());
                                                 for (std::size_t c = 0; c < values.size(); ++c)
                                                   values[c].push_back(sample.value_mm[c]);
                                               });
  StationaryRecord out;
  out.first_s = kResamplingEdge_s;
  out.series.rate_hz = kResampled_hz;
  out.series.unit = "mm";
  out.series.channels = result.ways.front().channels;
  for (const auto& channel : values) out.series.value.push_back(resampled(channel, kFrameRate_hz, kResampled_hz));
  return out;
}

}  // namespace tools

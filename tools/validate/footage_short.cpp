// Records of a few cycles of the lowest mode, and of noise alone: counts false modes.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/simulation/random_stream.h"
#include "core/simulation/track_generator.h"
#include "firmware_app/replay/analysis.h"
#include "firmware_app/replay/track_analysis.h"
#include "tools/validate/footage.h"
#include "tools/validate/geometry_flight.h"
#include "tools/validate/identification_match.h"
#include "tools/validate/identification_parallel.h"

namespace tools {
namespace {

using core::simulation::TrueMode;

constexpr std::array kCycles{0.5, 1.0, 2.0, 5.0, 10.0, 20.0};
constexpr double kNear = 0.02, kLeastMac = 0.8;

// Structural modes of a record, and the false ones among them: farther from every true mode than 2 % and than one over
// the record, or of another shape.
struct Tally {
  int n_structural = 0, n_false = 0, n_candidates = 0;
  bool refused = false;
  double worst_hz = 0.0;  // of a false one, for the reader
};

Tally tally_of(const core::ModalEstimate& estimate, const std::vector<TrueMode>& truth,
               const std::vector<core::ChannelInfo>& channels) {
  Tally out;
  out.n_structural = static_cast<int>(estimate.modes.size());
  for (const core::Mode& mode : estimate.rejected)
    out.n_candidates += mode.verdict == core::Verdict::kCandidate ? 1 : 0;
  for (const core::Mode& mode : estimate.modes) {
    const bool is_true = std::any_of(truth.begin(), truth.end(), [&](const TrueMode& one) {
      const double near_hz = std::max(kNear * one.frequency_hz, 1.0 / estimate.duration_s);
      return std::abs(mode.frequency_hz - one.frequency_hz) < near_hz && shape_mac(one, mode, channels) > kLeastMac;
    });
    if (!is_true) ++out.n_false, out.worst_hz = mode.frequency_hz;
  }
  return out;
}

// By the service's chain and, from the same displacements, as a time series with an automatic segment.
struct BothWays {
  Tally service, series;
};

core::ModalEstimate of_series(const app::ChannelSeries& series, Tally& out) {
  try {
    return app::identify_series(series, {}).estimate;
  } catch (const std::invalid_argument&) {  // shorter than any segment
    out.refused = true;
    return {};
  }
}

BothWays tracks_of_cycles(double cycles, std::uint64_t seed) {
  const FlightSetup setup{.scene = "preset: paper\n"};
  const double lowest_hz = modes_of(flight_job(setup, seed, 10.0, {}).scene().structure).front().frequency_hz;
  const SimulateJob job = flight_job(setup, seed, cycles / lowest_hz, {});
  const core::simulation::TrackGenerator generator(job.scene());
  const DeclaredRun declared = declared_run(job, setup, {}, generator.motion());
  auto timing = generator.timing();
  core::TrackFrame frame;
  std::unique_ptr<app::TrackAnalysis> analysis;
  app::ChannelSeries series;
  for (core::simulation::DeliveredFrame delivered; timing.next(delivered);) {
    generator.generate(delivered, frame);
    if (!analysis) {
      analysis = std::make_unique<app::TrackAnalysis>(declared.config, declared.camera, frame);
      series.rate_hz = declared.camera.rate_hz, series.channels = analysis->channels();
      series.value.resize(series.channels.size());
    }
    (void)analysis->push(frame);
    for (std::size_t c = 0; c < series.value.size(); ++c)
      series.value[c].push_back(analysis->sample().seen[c] != 0 ? analysis->sample().value_mm[c] : std::nan(""));
  }
  const std::vector<TrueMode> truth = modes_of(job.scene().structure);
  BothWays out;
  out.service = tally_of(analysis->finish(), truth, series.channels);
  const core::ModalEstimate estimate = of_series(series, out.series);
  const bool refused = out.series.refused;
  out.series = tally_of(estimate, truth, series.channels);
  out.series.refused = refused;
  return out;
}

// Independent white noise in every channel, at the camera's rate.
BothWays noise_of(std::size_t n_samples, std::uint64_t seed) {
  constexpr std::size_t kChannels = 7;
  app::AppConfig config;
  app::ChannelSeries series;
  series.rate_hz = 25.0;
  for (std::size_t c = 0; c < kChannels; ++c) {
    core::ChannelInfo channel;
    channel.region = static_cast<std::uint16_t>(c), channel.name = fmt::format("floor{}", c + 1);
    series.channels.push_back(channel);
    core::simulation::RandomStream noise(seed, "noise", c);
    auto& values = series.value.emplace_back();
    for (std::size_t t = 0; t < n_samples; ++t) values.push_back(noise.gaussian());
  }
  app::ChannelAnalysis analysis(config, series.channels, series.rate_hz);
  core::DisplacementSample sample;
  sample.seen.assign(kChannels, 1), sample.sigma_mm.assign(kChannels, 0.0), sample.n_points.assign(kChannels, 1);
  for (std::size_t t = 0; t < n_samples; ++t) {
    sample.sequence = t;
    sample.t_start_ns = std::llround(1e9 * static_cast<double>(t) / series.rate_hz);
    sample.value_mm.clear();
    for (const auto& values : series.value) sample.value_mm.push_back(values[t]);
    (void)analysis.push(sample);
  }
  BothWays out;
  out.service = tally_of(analysis.finish(), {}, series.channels);
  const core::ModalEstimate estimate = of_series(series, out.series);
  const bool refused = out.series.refused;
  out.series = tally_of(estimate, {}, series.channels);
  out.series.refused = refused;
  return out;
}

void print_line(const std::string& what, const std::vector<BothWays>& records, Tally BothWays::*way, const char* name) {
  int n_structural = 0, n_false = 0, n_with_false = 0, n_candidates = 0, n_refused = 0;
  for (const BothWays& record : records) {
    const Tally& tally = record.*way;
    n_structural += tally.n_structural, n_false += tally.n_false, n_candidates += tally.n_candidates;
    n_with_false += tally.n_false > 0 ? 1 : 0, n_refused += tally.refused ? 1 : 0;
  }
  fmt::print("short\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\n", what, name, records.size(), n_structural, n_false, n_with_false,
             n_candidates, n_refused);
}

}  // namespace

void print_short(const FootageOptions& options) {
  fmt::print(
      "# short: record, way, records, structural modes, of them false, records with a false one, candidates, records "
      "refused\n");
  const auto print_both = [](const std::string& what, const std::vector<BothWays>& records) {
    print_line(what, records, &BothWays::service, "service");
    print_line(what, records, &BothWays::series, "series");
  };
  for (const double cycles : kCycles)
    print_both(fmt::format("{} cycles", cycles),
               for_each_seed(options, [&](std::uint64_t seed) { return tracks_of_cycles(cycles, seed); }));
  for (const std::size_t n_samples : {28U, 75U, 150U, 300U, 750U, 1500U})
    print_both(fmt::format("noise {}", n_samples),
               for_each_seed(options, [&](std::uint64_t seed) { return noise_of(n_samples, seed); }));
}

}  // namespace tools

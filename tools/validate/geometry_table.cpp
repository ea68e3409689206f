// Table 1 of Yoon, Hoskere, Park & Spencer 2017, column by column, on simulated records.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/identification/mac.h"
#include "tools/validate/geometry.h"
#include "tools/validate/geometry_pictures.h"
#include "tools/validate/geometry_score.h"
#include "tools/validate/geometry_sensors.h"
#include "tools/validate/identification_match.h"
#include "tools/validate/identification_parallel.h"

namespace tools {
namespace {

using As = Found::As;
constexpr std::size_t kTableModes = 3;
constexpr std::array<const char*, 4> kSensors{"accelerometers", "stationary", "paper", "ours"};

// As published: Hz of accelerometers, stationary camera, UAV; MAC of the two cameras, %; error of the two, %.
struct PublishedMode {
  double accelerometers_hz, stationary_hz, uav_hz, stationary_mac, uav_mac, stationary_error, uav_error;
};
constexpr std::array<PublishedMode, kTableModes> kPublished{{{1.632, 1.649, 1.649, 99.99, 99.99, 1.04, 1.04},
                                                             {5.054, 5.060, 5.043, 99.99, 99.86, 0.12, 0.22},
                                                             {8.175, 8.166, 8.170, 99.99, 99.67, 0.11, 0.06}}};

// The floors' components, from the lowest.
std::vector<std::complex<double>> floors(const core::Mode& mode, const std::vector<core::ChannelInfo>& channels) {
  std::vector<std::complex<double>> out;
  for (std::size_t c = 0; c < mode.shape.size() && c < channels.size(); ++c) {
    if (!channels[c].is_base) out.push_back(mode.shape[c]);
  }
  return out;
}

core::IdentifierConfig half_rate(double max_frequency_hz) {
  core::IdentifierConfig config;
  config.max_frequency_hz = max_frequency_hz;
  return config;
}

SensorMode sensor_mode(const Found& found, const std::vector<core::ChannelInfo>& channels) {
  if (found.as != As::kRight) return {};
  return {true, found.mode.frequency_hz, floors(found.mode, channels)};
}

// [sensor][mode]
using Table = std::vector<std::vector<SensorMode>>;

std::vector<SensorMode> sensor_modes(const core::ModalEstimate& estimate,
                                     const std::vector<core::ChannelInfo>& channels,
                                     const std::vector<core::simulation::TrueMode>& truth) {
  const Match match = match_modes(estimate, truth, channels);
  std::vector<SensorMode> out;
  for (std::size_t r = 0; r < kTableModes; ++r) out.push_back(sensor_mode(match.modes[r], channels));
  return out;
}

Table table_of(std::uint64_t seed, const GeometryOptions& options, PaperPictures* pictures) {
  const FlightSetup setup = paper_flight();
  const SimulateJob job = flight_job(setup, seed, 300.0, options);
  const auto truth = shaken_modes(job.scene());
  const app::ChannelSeries acceleration = accelerations(job.scene());
  const app::SeriesResult reference = app::identify_series(
      acceleration, {.spectrum = {.segment = 0}, .identifier = half_rate(12.5), .report_directory = {}, .source = {}});
  const StationaryRecord stationary = stationary_camera(seed, job.scene().duration_s);
  const app::SeriesResult still = app::identify_series(
      stationary.series,
      {.spectrum = {.segment = 0}, .identifier = half_rate(0.0), .report_directory = {}, .source = {}});
  const AnalysedFlight flight = analyse_flight(job, setup, {{"paper", {"method=paper"}}, {"ours", {}}},
                                               [&](std::size_t way, const auto& sample, const auto& true_sample) {
                                                 if (pictures != nullptr && way == 0)
                                                   pictures->add(sample, true_sample);
                                               });
  Table table{sensor_modes(reference.estimate, reference.channels, truth),
              sensor_modes(still.estimate, still.channels, truth)};
  for (const Analysed& way : flight.ways) table.push_back(sensor_modes(way.measured, way.channels, truth));
  if (pictures != nullptr) pictures->draw({job, acceleration, stationary, flight, table});
  return table;
}

void print_row(std::size_t sensor, std::size_t mode, const std::vector<Table>& records) {
  std::vector<double> frequency, error, mac_deficit;
  for (const Table& table : records) {
    const SensorMode &found = table[sensor][mode], &reference = table[0][mode];
    if (!found.found) continue;
    frequency.push_back(found.frequency_hz);
    if (!reference.found) continue;
    error.push_back(1e2 * std::abs(found.frequency_hz / reference.frequency_hz - 1.0));
    mac_deficit.push_back(1e2 * (core::mac(found.shape, reference.shape) - 1.0));
  }
  const Statistics f = statistics(frequency), e = statistics(error), m = statistics(mac_deficit);
  const double known = error.empty() ? std::nan("") : 1.0;  // no figure without a record
  fmt::print("table1\t{}\t{}\t{}\t{}\t{:.4f}\t{:.3f}\t{:.3f}\t{:.3f}\t{:.3f}\n", kSensors[sensor], mode + 1,
             records.size(), f.n, f.median, known * e.median, known * e.worst, known * (100.0 + m.median),
             known * (100.0 + m.worst));
}

}  // namespace

void print_table1(const GeometryOptions& options) {
  fmt::print(
      "# table1: sensor, mode, records, found in; Hz median; against the accelerometers of the same record: error %\n"
      "#   median, worst, MAC of the floors % median, worst\n"
      "# table1-published: mode; Hz of accelerometers, stationary camera, UAV; MAC of the cameras %; their errors %\n");
  const auto records = for_each_seed(options, [&](std::uint64_t seed) {
    if (seed != static_cast<std::uint64_t>(options.first_seed) || options.report.empty())
      return table_of(seed, options, nullptr);
    PaperPictures pictures(options.report);
    return table_of(seed, options, &pictures);
  });
  for (std::size_t sensor = 0; sensor < kSensors.size(); ++sensor) {
    for (std::size_t mode = 0; mode < kTableModes; ++mode) print_row(sensor, mode, records);
  }
  for (std::size_t mode = 0; mode < kTableModes; ++mode) {
    const PublishedMode& p = kPublished[mode];
    fmt::print("table1-published\t{}\t{:.3f}\t{:.3f}\t{:.3f}\t{:.2f}\t{:.2f}\t{:.2f}\t{:.2f}\n", mode + 1,
               p.accelerometers_hz, p.stationary_hz, p.uav_hz, p.stationary_mac, p.uav_mac, p.stationary_error,
               p.uav_error);
  }
}

}  // namespace tools

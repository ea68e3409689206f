// The paper's own experiment by its published chain, compared with the other reading of Eq. 8 and with method
// hovermodal.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdio>
#include <string>
#include <vector>

#include "core/identification/mac.h"
#include "core/identification/real_shape.h"
#include "tools/validate/geometry.h"
#include "tools/validate/geometry_score.h"
#include "tools/validate/geometry_sensors.h"
#include "tools/validate/identification_match.h"
#include "tools/validate/identification_parallel.h"

namespace tools {
namespace {

using Shape = std::vector<std::complex<double>>;
constexpr std::size_t kPaperModes = 3;
constexpr std::array kReadouts_ms{40.0, 26.0};  // a frame of 25 fps, as Eq. 7 has it, and the camera's own

struct ModeResult {
  bool found = false;
  // Against the identification of the true motion, %, and the structure's true shape.
  double frequency_error = std::nan(""), real_mac = std::nan(""), complex_mac = std::nan("");
};
struct RecordResult {
  std::array<ModeResult, kPaperModes> modes;
  int n_false = 0;

  [[nodiscard]] int n_found() const {
    return static_cast<int>(std::count_if(modes.begin(), modes.end(), [](const ModeResult& m) { return m.found; }));
  }
};

// The floors alone: the paper's accelerometers stood on them.
Shape floors(const Shape& shape, const std::vector<core::ChannelInfo>& channels) {
  Shape out;
  for (std::size_t c = 0; c < shape.size() && c < channels.size(); ++c) {
    if (!channels[c].is_base) out.push_back(shape[c]);
  }
  return out;
}

ModeResult mode_result(const Found& found, const Found& reference, const Shape& truth,
                       const std::vector<core::ChannelInfo>& channels) {
  if (found.as != Found::As::kRight) return {};
  ModeResult out{true};
  if (reference.as == Found::As::kRight)
    out.frequency_error = 1e2 * (found.mode.frequency_hz / reference.mode.frequency_hz - 1.0);
  const Shape measured = floors(found.mode.shape, channels), expected = floors(truth, channels);
  out.real_mac = core::real_mac(measured, expected);
  out.complex_mac = core::mac(measured, expected);
  return out;
}

RecordResult record_result(const Analysed& way, const std::vector<core::simulation::TrueMode>& truth) {
  const Match measured = match_modes(way.measured, truth, way.channels);
  const Match reference = match_modes(way.truth, truth, way.channels);
  RecordResult out;
  out.n_false = measured.n_false;
  for (std::size_t r = 0; r < kPaperModes; ++r)
    out.modes[r] = mode_result(measured.modes[r], reference.modes[r], true_shape(truth[r], way.channels), way.channels);
  return out;
}

void print_record(double readout_ms, const std::string& way, std::uint64_t seed, const RecordResult& record) {
  fmt::print("paper-record\t{:g}\t{}\t{}\t{}", readout_ms, way, seed, record.n_found());
  for (const ModeResult& mode : record.modes)
    fmt::print("\t{:+.4f}\t{:.5f}\t{:.5f}", mode.frequency_error, mode.real_mac, mode.complex_mac);
  fmt::print("\t{}\n", record.n_false);
}

// Median and worst over the records in which the mode was found; worst: farthest from `perfect`.
std::string median_and_worst(const std::vector<RecordResult>& records, std::size_t mode, double ModeResult::*value,
                             double perfect, int digits) {
  std::vector<double> deficits;
  for (const RecordResult& record : records) {
    const double x = record.modes[mode].*value;
    if (std::isfinite(x)) deficits.push_back(perfect == 0.0 ? std::abs(x) : x - perfect);
  }
  const double known = deficits.empty() ? std::nan("") : 1.0;
  const Statistics s = statistics(deficits);
  return fmt::format("{:.{}f}\t{:.{}f}", known * (perfect + s.median), digits, known * (perfect + s.worst), digits);
}

void print_summary(double readout_ms, const std::string& way, const std::vector<RecordResult>& records) {
  int n_complete = 0;
  double n_false = 0.0;
  for (const RecordResult& record : records) {
    n_complete += record.n_found() == static_cast<int>(kPaperModes) ? 1 : 0;
    n_false += record.n_false;
  }
  fmt::print("paper\t{:g}\t{}\t{}\t{}", readout_ms, way, records.size(), n_complete);
  for (std::size_t r = 0; r < kPaperModes; ++r) {
    const auto n_found = std::count_if(records.begin(), records.end(),
                                       [&](const RecordResult& record) { return record.modes[r].found; });
    fmt::print("\t{}\t{}\t{}\t{}", n_found, median_and_worst(records, r, &ModeResult::frequency_error, 0.0, 4),
               median_and_worst(records, r, &ModeResult::real_mac, 1.0, 5),
               median_and_worst(records, r, &ModeResult::complex_mac, 1.0, 5));
  }
  fmt::print("\t{:.2f}\n", n_false / static_cast<double>(records.size()));
}

}  // namespace

void print_paper(const GeometryOptions& options) {
  fmt::print(
      "# paper-record: readout ms, way, seed, of modes 1-3 found; of each: frequency against the true motion's own\n"
      "#   identification %, MAC of the floors with the true shape, real and complex; structural poles that are no "
      "mode\n"
      "# paper: readout ms, way, records, with all of modes 1-3; of each mode: found in, |frequency error| % median,\n"
      "#   worst, real MAC median, worst, complex MAC median, worst; per record: structural poles that are no mode\n");
  const std::vector<Way> ways{
      {"paper", {"method=paper"}}, {"region", {"method=paper", "paper.velocity=region"}}, {"ours"}};
  for (const double readout_ms : kReadouts_ms) {
    const FlightSetup setup = paper_flight(readout_ms);
    const auto records = for_each_seed(
        options.n_seeds, options.n_threads,
        [&](std::uint64_t seed) {
          const SimulateJob job = flight_job(setup, seed, 300.0, options);
          const AnalysedFlight flight = analyse_flight(job, setup, ways);
          std::vector<RecordResult> out;
          for (const Analysed& way : flight.ways) out.push_back(record_result(way, shaken_modes(job.scene())));
          return out;
        },
        options.first_seed);
    for (std::size_t w = 0; w < ways.size(); ++w) {
      std::vector<RecordResult> of_way;
      for (std::size_t i = 0; i < records.size(); ++i) {
        of_way.push_back(records[i][w]);
        print_record(readout_ms, ways[w].name, static_cast<std::uint64_t>(options.first_seed) + i, of_way.back());
      }
      print_summary(readout_ms, ways[w].name, of_way);
      std::fflush(stdout);
    }
  }
}

}  // namespace tools

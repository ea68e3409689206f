// Modes above half the frame rate, told by the instants at which the rows are seen.
#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>

#include "core/identification/readout_from_shapes.h"
#include "tools/hovermodal/selftest/identification.h"
#include "tools/hovermodal/selftest/identification_match.h"
#include "tools/hovermodal/selftest/identification_parallel.h"
#include "tools/hovermodal/selftest/identification_scene.h"

namespace tools {
namespace {

using core::simulation::TrueMode;
using Shaken = StoreysSetup::Shaken;
constexpr double kMaxFrequency_hz = 20.0;
constexpr double kLeastMac = 0.98;

struct FoldingCase {
  std::string name;
  StoreysSetup setup;
  std::vector<std::size_t> keep;  // channels; empty: all floors
  bool reads_off = false;         // the readout from the shapes, too
};

std::vector<FoldingCase> folding_cases() {
  std::vector<FoldingCase> cases;
  for (const double readout : {0.66, 0.9}) {
    StoreysSetup setup{.rate_hz = 25.0, .readout_frames = readout};
    for (const double duration_s : {300.0, 600.0}) {
      setup.duration_s = duration_s;
      for (const double noise_px : {0.003, 0.1}) {
        setup.shaken = Shaken::kModalParts;
        setup.noise_px = noise_px;
        cases.push_back({fmt::format("parts-{}px", noise_px), setup, {}, noise_px < 0.01});
      }
      setup.noise_px = 0.003;
      setup.shaken = Shaken::kBase;
      cases.push_back({"base", setup, {}});
    }
    setup.duration_s = 300.0;
    setup.shaken = Shaken::kModalParts;
    cases.push_back({"two-channels", setup, {1, 4}});
    setup.row_span = 0.1;
    cases.push_back({"span-0.1", setup, {}});
  }
  return cases;
}

using core::ReadoutFromShapes;
struct Outcome {
  Match match;
  std::optional<ReadoutFromShapes> stated, unknown;  // identified with the true readout, and without any
};

// Poles that stand in nearly all orders; what was called out of phase is so because its delays are not undone.
std::optional<ReadoutFromShapes> read_off_shapes(const Record& record, const core::ModalEstimate& estimate,
                                                 bool delays_undone, double readout_frames) {
  constexpr double kLeastPresence = 0.85, kMostDamping = 0.05;
  std::vector<core::ChannelInfo> channels = record.channels;
  std::vector<double> row_share;
  for (core::ChannelInfo& channel : channels) {
    row_share.push_back(channel.row_delay_s * record.rate_hz / readout_frames);
    if (!delays_undone) channel.row_delay_s = 0.0;
  }
  std::vector<core::ObservedPole> poles;
  for (const auto* list : {&estimate.modes, &estimate.rejected}) {
    for (const core::Mode& mode : *list) {
      if (mode.presence < kLeastPresence || !(mode.damping_ratio > 0.0 && mode.damping_ratio < kMostDamping)) continue;
      poles.push_back(core::observed_pole(mode, channels, record.rate_hz));
    }
  }
  return core::readout_from_shapes(poles, row_share, {record.rate_hz, kMaxFrequency_hz, 1.0});
}

Outcome judge(const FoldingCase& which, std::uint64_t seed, const std::vector<TrueMode>& truth) {
  Record record = structure_record(storeys_scene(which.setup, seed), false);
  if (!which.keep.empty()) record = select_channels(record, which.keep);
  const core::CpsdSums sums = spectra(record);
  core::IdentifierConfig config = identifier_config(kMaxFrequency_hz);
  const core::ModalEstimate estimate = core::Identifier(config, record.channels).identify(sums);
  Outcome outcome{match_modes(estimate, truth, record.channels), {}, {}};
  if (!which.reads_off) return outcome;
  outcome.stated = read_off_shapes(record, estimate, true, which.setup.readout_frames);
  config.undo_row_delays = false;
  outcome.unknown = read_off_shapes(record, core::Identifier(config, record.channels).identify(sums), false,
                                    which.setup.readout_frames);
  return outcome;
}

void print_readout(const FoldingCase& which, const char* delays, const std::vector<Outcome>& records,
                   std::optional<ReadoutFromShapes> Outcome::*which_readout) {
  std::vector<double> error, spread;
  for (const Outcome& record : records) {
    if (!(record.*which_readout)) continue;
    error.push_back((record.*which_readout)->readout_frames - which.setup.readout_frames);
    spread.push_back((record.*which_readout)->std_frames);
  }
  const Statistics e = statistics(error), s = statistics(spread);
  fmt::print("folding-readout\t{}\t{:.2f}\t{:.0f}\t{}\t{}\t{}\t{:+.4f}\t{:.4f}\t{:.4f}\t{:.4f}\n", which.name,
             which.setup.readout_frames, which.setup.duration_s, delays, records.size(), e.n, e.mean, e.rms,
             std::abs(e.worst), s.median);
}

void print_mode(const FoldingCase& which, std::size_t r, const TrueMode& truth, const std::vector<Outcome>& records) {
  using As = Found::As;
  int right = 0, wrong = 0, ambiguous = 0, high_mac = 0;
  std::vector<double> f, zeta;
  double least_mac = 1.0;
  std::optional<double> least_margin;  // none: no other frequency below the limit
  for (const Outcome& record : records) {
    const Found& found = record.match.modes[r];
    wrong += found.as == As::kWrongFold ? 1 : 0;
    ambiguous += found.as == As::kAmbiguous ? 1 : 0;
    if (found.as != As::kRight) continue;
    ++right;
    f.push_back(1e2 * (found.mode.frequency_hz / truth.frequency_hz - 1.0));
    zeta.push_back(1e2 * (found.mode.damping_ratio / truth.damping_ratio - 1.0));
    high_mac += found.mac >= kLeastMac ? 1 : 0;
    least_mac = std::min(least_mac, found.mac);
    if (found.mode.fold_margin) least_margin = std::min(least_margin.value_or(1.0), *found.mode.fold_margin);
  }
  const Statistics sf = statistics(f), sz = statistics(zeta);
  fmt::print("folding\t{}\t{:.2f}\t{:.0f}\t{:.3f}\t{}\t{}\t{}\t{}\t{}\t{:.4f}\t{:+.4f}\t{:.1f}\t{}\t{:.4f}\t{}\n",
             which.name, which.setup.readout_frames, which.setup.duration_s, truth.frequency_hz, records.size(),
             right + wrong + ambiguous, right, wrong, ambiguous, sf.rms, sf.worst, sz.rms, high_mac, least_mac,
             least_margin ? fmt::format("{:.3f}", *least_margin) : "-");
}

}  // namespace

void print_folding(const IdentificationOptions& options) {
  fmt::print(
      "# folding: case, readout in frames, seconds, true Hz, records; found in any way, certain and right, certain "
      "and\n"
      "#   wrong, ambiguous; f: rms %, worst %; damping: rms %; MAC of at least {}, least MAC; least fold margin\n"
      "# folding-all: case, readout, seconds, records, structural poles that are no mode\n"
      "# folding-readout: case, readout, seconds, delays stated or unknown, records, read off the shapes in; frames: "
      "mean\n"
      "#   error, rms, worst, median of the stated spread\n",
      kLeastMac);
  for (const FoldingCase& which : folding_cases()) {
    const std::vector<TrueMode> truth = modes_of(storeys_scene(which.setup, 1).structure);
    const auto records = for_each_seed(options.n_seeds, options.n_threads,
                                       [&](std::uint64_t seed) { return judge(which, seed, truth); });
    for (std::size_t r = 0; r < truth.size(); ++r) print_mode(which, r, truth[r], records);
    int n_false = 0;
    for (const Outcome& record : records) n_false += record.match.n_false;
    fmt::print("folding-all\t{}\t{:.2f}\t{:.0f}\t{}\t{}\n", which.name, which.setup.readout_frames,
               which.setup.duration_s, records.size(), n_false);
    if (!which.reads_off) continue;
    print_readout(which, "stated", records, &Outcome::stated);
    print_readout(which, "unknown", records, &Outcome::unknown);
  }
}

}  // namespace tools

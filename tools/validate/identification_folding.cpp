// Modes above half the frame rate: their alias order from the row delays.
#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>

#include "core/identification/readout_from_shapes.h"
#include "tools/validate/identification.h"
#include "tools/validate/identification_match.h"
#include "tools/validate/identification_parallel.h"
#include "tools/validate/identification_scene.h"

namespace tools {
namespace {

using core::simulation::TrueMode;
using Shaken = StoreysSetup::Shaken;
constexpr double kLeastMac = 0.98, kClearFold_db = 20.0;

struct FoldingCase {
  std::string name;
  StoreysSetup setup;
  bool two_channels = false;  // or all floors
  bool reads_off = false;     // estimate the readout from the shapes, too
  bool is_drawn = false;      // camera, structure and noise; the readout is the case's
};

std::vector<FoldingCase> folding_cases() {
  std::vector<FoldingCase> cases;
  for (const double readout : {0.66, 0.9}) {
    StoreysSetup setup{.rate_hz = 25.0, .readout_frames = readout};
    for (const double duration_s : {300.0, 600.0}) {
      setup.duration_s = duration_s;
      setup.shaken = Shaken::kModalParts;
      for (const double noise_px : {0.003, 0.1}) {
        setup.noise_px = noise_px;
        cases.push_back({fmt::format("parts-{}px", noise_px), setup, false, noise_px < 0.01});
      }
      cases.push_back({"parts", setup, false, true, true});
      setup.noise_px = 0.003;
      setup.shaken = Shaken::kBase;
      for (const bool is_drawn : {false, true}) cases.push_back({"base", setup, false, false, is_drawn});
    }
    setup.duration_s = 300.0;
    setup.shaken = Shaken::kModalParts;
    for (const bool is_drawn : {false, true}) cases.push_back({"two-channels", setup, true, false, is_drawn});
    setup.row_span = 0.1;
    for (const bool is_drawn : {false, true}) cases.push_back({"span-0.1", setup, false, false, is_drawn});
  }
  return cases;
}

// In drawn cases the highest mode lies at 0.52 ... 0.75 of the frame rate.
StoreysSetup setup_of(const FoldingCase& which, std::uint64_t seed) {
  if (!which.is_drawn) return which.setup;
  StoreysSetup setup = drawn_storeys(which.setup, seed, {.least_top = 0.52, .most_top = 0.75, .keeps_readout = true});
  if (which.setup.row_span < 0.5) setup.row_span = which.setup.row_span;
  return setup;
}

using core::ReadoutFromShapes;
struct Outcome {
  std::vector<TrueMode> truth;
  std::vector<double> peaks_db;
  double rate_hz = 0.0;
  Match match;
  std::optional<ReadoutFromShapes> stated, unknown;  // identified with the true readout, and without any
};

// Poles present in nearly all orders; those rejected as out of phase are so because their delays are not corrected.
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
  return core::readout_from_shapes(poles, row_share, {record.rate_hz, fold_limit_hz(record.rate_hz), 1.0});
}

Outcome judge(const FoldingCase& which, std::uint64_t seed) {
  const StoreysSetup setup = setup_of(which, seed);
  const core::simulation::Scene scene = storeys_scene(setup, seed);
  Record record = structure_record(scene, false);
  if (which.two_channels) record = select_channels(record, {1, record.channels.size() - 2});
  const core::CpsdSums sums = spectra(record);
  core::IdentifierConfig config = identifier_config(fold_limit_hz(setup.rate_hz));
  const core::ModalEstimate estimate = core::Identifier(config, record.channels).identify(sums);
  Outcome outcome{modes_of(scene.structure), peaks_over_noise_db(scene), setup.rate_hz, {}, {}, {}};
  outcome.match = match_modes(estimate, outcome.truth, record.channels);
  if (!which.reads_off) return outcome;
  outcome.stated = read_off_shapes(record, estimate, true, setup.readout_frames);
  config.undo_row_delays = false;
  outcome.unknown =
      read_off_shapes(record, core::Identifier(config, record.channels).identify(sums), false, setup.readout_frames);
  return outcome;
}

const char* tag(const FoldingCase& which) { return which.is_drawn ? "-drawn" : ""; }

void print_readout(const FoldingCase& which, const char* delays, const std::vector<Outcome>& records,
                   std::optional<ReadoutFromShapes> Outcome::*which_readout) {
  std::vector<double> error, spread;
  for (const Outcome& record : records) {
    if (!(record.*which_readout)) continue;
    error.push_back((record.*which_readout)->readout_frames - which.setup.readout_frames);
    spread.push_back((record.*which_readout)->std_frames);
  }
  const Statistics e = statistics(error), s = statistics(spread);
  fmt::print("folding-readout{}\t{}\t{:.2f}\t{:.0f}\t{}\t{}\t{}\t{:+.4f}\t{:.4f}\t{:.4f}\t{:.4f}\n", tag(which),
             which.name, which.setup.readout_frames, which.setup.duration_s, delays, records.size(), e.n, e.mean, e.rms,
             std::abs(e.worst), s.median);
}

// Results for the modes of one kind.
struct Tally {
  int n = 0, right = 0, wrong = 0, ambiguous = 0, high_mac = 0;
  std::vector<double> f, zeta;  // errors, %
  double least_mac = 1.0;
  std::optional<double> least_margin;  // empty: no other frequency below the limit

  void add(const Found& found, const TrueMode& truth) {
    ++n;
    wrong += found.as == Found::As::kWrongFold ? 1 : 0;
    ambiguous += found.as == Found::As::kAmbiguous ? 1 : 0;
    if (found.as != Found::As::kRight) return;
    ++right;
    f.push_back(1e2 * (found.mode.frequency_hz / truth.frequency_hz - 1.0));
    zeta.push_back(1e2 * (found.mode.damping_ratio / truth.damping_ratio - 1.0));
    high_mac += found.mac >= kLeastMac ? 1 : 0;
    least_mac = std::min(least_mac, found.mac);
    if (found.mode.fold_margin) least_margin = std::min(least_margin.value_or(1.0), *found.mode.fold_margin);
  }
};

void print_tally(const FoldingCase& which, const std::string& modes, const Tally& t) {
  const Statistics sf = statistics(t.f), sz = statistics(t.zeta);
  fmt::print("folding{}\t{}\t{:.2f}\t{:.0f}\t{}\t{}\t{}\t{}\t{}\t{}\t{:.4f}\t{:+.4f}\t{:.1f}\t{}\t{:.4f}\t{}\n",
             tag(which), which.name, which.setup.readout_frames, which.setup.duration_s, modes, t.n,
             t.right + t.wrong + t.ambiguous, t.right, t.wrong, t.ambiguous, sf.rms, sf.worst, sz.rms, t.high_mac,
             t.least_mac, t.least_margin ? fmt::format("{:.3f}", *t.least_margin) : "-");
}

// Whether no other frequency up to the limit has the same alias below half the rate.
bool has_no_rival(const Outcome& record, std::size_t r) {
  return record.truth[r].frequency_hz < record.rate_hz - fold_limit_hz(record.rate_hz);
}

void print_drawn(const FoldingCase& which, const std::vector<Outcome>& records) {
  const auto kind_of = [](const Outcome& record, std::size_t r) -> std::string {
    const bool is_folded = record.truth[r].frequency_hz > 0.5 * record.rate_hz;
    const char* kind = is_folded ? "folded" : (has_no_rival(record, r) ? "alone" : "direct");
    return fmt::format("{}{}", kind, record.peaks_db[r] >= kClearFold_db ? "" : "-weak");
  };
  for (const char* kind : {"alone", "direct", "folded", "alone-weak", "direct-weak", "folded-weak"}) {
    Tally tally;
    for (const Outcome& record : records) {
      for (std::size_t r = 0; r < record.truth.size(); ++r) {
        if (kind_of(record, r) == kind) tally.add(record.match.modes[r], record.truth[r]);
      }
    }
    if (tally.n > 0) print_tally(which, kind, tally);
  }
}

void print_modes(const FoldingCase& which, const std::vector<Outcome>& records) {
  for (std::size_t r = 0; r < storey_frequencies_hz().size(); ++r) {
    Tally tally;
    for (const Outcome& record : records) tally.add(record.match.modes[r], record.truth[r]);
    print_tally(which, fmt::format("{:.3f}", records.front().truth[r].frequency_hz), tally);
  }
}

void print_case(const FoldingCase& which, const std::vector<Outcome>& records) {
  if (which.is_drawn) {
    print_drawn(which, records);
  } else {
    print_modes(which, records);
  }
  int n_false = 0;
  for (const Outcome& record : records) n_false += record.match.n_false;
  fmt::print("folding-all{}\t{}\t{:.2f}\t{:.0f}\t{}\t{}\n", tag(which), which.name, which.setup.readout_frames,
             which.setup.duration_s, records.size(), n_false);
  if (!which.reads_off) return;
  print_readout(which, "stated", records, &Outcome::stated);
  print_readout(which, "unknown", records, &Outcome::unknown);
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
      "#   error, rms, worst, median of the stated spread\n"
      "# folding-drawn and so on: the same with camera, structure and noise drawn, the highest mode above half the\n"
      "#   rate; for true Hz and records: kind of mode (alone: without rival below the limit; direct, folded: below "
      "or\n"
      "#   above half the rate; weak: peak less than {} dB over the noise), modes of all records\n",
      kLeastMac, kClearFold_db);
  for (const FoldingCase& which : folding_cases()) {
    print_case(which, for_each_seed(options, [&](std::uint64_t seed) { return judge(which, seed); }));
  }
}

}  // namespace tools

// Modes above half the frame rate, told by the instants at which the rows are seen.
#include <fmt/format.h>

#include <cmath>
#include <string>

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
        cases.push_back({fmt::format("parts-{}px", noise_px), setup, {}});
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

struct Outcome {
  Match match;
};

void print_mode(const FoldingCase& which, std::size_t r, const TrueMode& truth, const std::vector<Outcome>& records) {
  using As = Found::As;
  int right = 0, wrong = 0, ambiguous = 0, high_mac = 0;
  std::vector<double> f, zeta;
  double least_mac = 1.0, least_margin = 1.0;
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
    least_margin = std::min(least_margin, found.mode.fold_margin.value_or(0.0));
  }
  const Statistics sf = statistics(f), sz = statistics(zeta);
  fmt::print("folding\t{}\t{:.2f}\t{:.0f}\t{:.3f}\t{}\t{}\t{}\t{}\t{}\t{:.4f}\t{:+.4f}\t{:.1f}\t{}\t{:.4f}\t{:.3f}\n",
             which.name, which.setup.readout_frames, which.setup.duration_s, truth.frequency_hz, records.size(),
             right + wrong + ambiguous, right, wrong, ambiguous, sf.rms, sf.worst, sz.rms, high_mac, least_mac,
             least_margin);
}

}  // namespace

void print_folding(const IdentificationOptions& options) {
  fmt::print(
      "# folding: case, readout in frames, seconds, true Hz, records; found in any way, certain and right, certain "
      "and\n"
      "#   wrong, ambiguous; f: rms %, worst %; damping: rms %; MAC of at least {}, least MAC; least fold margin\n"
      "# folding-all: case, readout, seconds, records, structural poles that are no mode\n",
      kLeastMac);
  for (const FoldingCase& which : folding_cases()) {
    const std::vector<TrueMode> truth = modes_of(storeys_scene(which.setup, 1).structure);
    const auto records = for_each_seed(options.n_seeds, options.n_threads, [&](std::uint64_t seed) {
      Record record = structure_record(storeys_scene(which.setup, seed), false);
      if (!which.keep.empty()) record = select_channels(record, which.keep);
      return Outcome{match_modes(identify_record(record, kMaxFrequency_hz), truth, record.channels)};
    });
    for (std::size_t r = 0; r < truth.size(); ++r) print_mode(which, r, truth[r], records);
    int n_false = 0;
    for (const Outcome& record : records) n_false += record.match.n_false;
    fmt::print("folding-all\t{}\t{:.2f}\t{:.0f}\t{}\t{}\n", which.name, which.setup.readout_frames,
               which.setup.duration_s, records.size(), n_false);
  }
}

}  // namespace tools

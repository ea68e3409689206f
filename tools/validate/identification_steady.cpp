// Steady forces near modes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tools/validate/identification.h"
#include "tools/validate/identification_parallel.h"
#include "tools/validate/identification_scene.h"
#include "tools/validate/identification_verdicts.h"

namespace tools {
namespace {

using core::Mode;
using core::simulation::Scene;

struct SteadyCase {
  double damping_ratio;  // 0: camera, structure and noise are drawn
  double line_share;     // rms of the line where the force acts, over that of the roof in the mode beside it
};

StoreysSetup steady_setup(const SteadyCase& which, std::uint64_t seed) {
  const StoreysSetup fixed{.shaken = StoreysSetup::Shaken::kModalParts,
                           .duration_s = 600.0,
                           .rate_hz = 25.0,
                           .damping_ratio = {which.damping_ratio}};
  return which.damping_ratio > 0.0 ? fixed : drawn_storeys(fixed, seed);
}

// A steady force on a floor, at 2 to 6 % of the frequency from one mode after the other.
struct SteadyLine {
  std::size_t mode;
  double frequency_hz, reach_hz;  // poles within reach are attributed to the line
};

SteadyLine steady_line(const StoreysSetup& setup, std::uint64_t seed) {
  SteadyLine line{static_cast<std::size_t>(seed) % setup.n_storeys(), 0.0, 0.0};
  const double mode_hz = setup.frequency_hz[line.mode];
  const double aside =
      drawn_between(seed, "line_aside", 0.02, 0.06) * (drawn_between(seed, "line_side", 0.0, 1.0) < 0.5 ? -1 : 1);
  line.frequency_hz = mode_hz * (1.0 + aside);
  line.reach_hz = std::min(0.05, 0.4 * std::abs(aside) * mode_hz);
  return line;
}

Scene steady_scene(const SteadyCase& which, const StoreysSetup& setup, std::uint64_t seed, bool with_line) {
  Scene scene = storeys_scene(setup, seed);
  const int body = 1 + static_cast<int>(seed / setup.n_storeys() % setup.n_storeys());
  const SteadyLine line = steady_line(setup, seed);
  const double line_rms_px = which.line_share * kModalParts.at(line.mode) * setup.roof_rms_px;
  if (with_line) scene.excitation.harmonics = {{body, line.frequency_hz, line_rms_px}};
  return scene;
}

struct SteadyOutcome {
  Judged with, without;
  std::size_t line = kVerdicts.size();  // verdict on it
  std::size_t beside = 0;               // the mode
};

SteadyOutcome judge_steady(const SteadyCase& which, std::uint64_t seed) {
  const StoreysSetup setup = steady_setup(which, seed);
  SteadyOutcome outcome;
  for (const bool with_line : {true, false}) {
    const Scene scene = steady_scene(which, setup, seed, with_line);
    (with_line ? outcome.with : outcome.without) =
        judge_record(structure_record(scene, false), fold_limit_hz(scene.camera.rate_hz), modes_of(scene.structure));
  }
  const SteadyLine line = steady_line(setup, seed);
  outcome.beside = line.mode;
  double nearest = line.reach_hz;
  for (const Mode& mode : all_poles(outcome.with.estimate)) {
    const double off = std::abs(mode.apparent_hz - apparent_hz(line.frequency_hz, outcome.with.estimate.rate_hz));
    if (off < nearest) nearest = off, outcome.line = place_of(mode.verdict);
  }
  return outcome;
}

void print_steady(const IdentificationOptions& options, const SteadyCase& which) {
  const auto records = for_each_seed(options, [&](std::uint64_t seed) { return judge_steady(which, seed); });
  VerdictCounts counts{};
  TrueModes with, without;
  std::vector<double> shift, error;  // of the mode beside the line, %
  for (const SteadyOutcome& record : records) {
    ++counts[record.line];
    with.add(record.with);
    without.add(record.without);
    const Found &a = record.with.match.modes[record.beside], &b = record.without.match.modes[record.beside];
    if (a.as != Found::As::kRight) continue;
    error.push_back(1e2 * (a.mode.frequency_hz / record.with.truth[record.beside].frequency_hz - 1.0));
    if (b.as == Found::As::kRight) shift.push_back(1e2 * (a.mode.frequency_hz / b.mode.frequency_hz - 1.0));
  }
  const Statistics s = statistics(shift), e = statistics(error);
  const bool is_drawn = which.damping_ratio == 0.0;
  fmt::print("steady{}\t{}\t{:.1f}\t{}{}\t{}\t{}\t{}\t{}\t{}\t{}\t{:.4f}\t{:.4f}\t{:.4f}\t{:.4f}\n",
             is_drawn ? "-drawn" : "", is_drawn ? "drawn" : fmt::format("{:.1f}", 1e2 * which.damping_ratio),
             which.line_share, records.size(), columns(counts), with.n, with.right, with.called_harmonic, without.right,
             without.called_harmonic, e.n, e.rms, std::abs(e.worst), s.rms, std::abs(s.worst));
}

}  // namespace

void print_harmonics(const IdentificationOptions& options) {
  fmt::print(
      "# rotor: channels, records; records by the gravest verdict on what the line left: {};\n"
      "#   true modes, of them right, called harmonic, called camera motion\n",
      verdict_names());
  for (const bool is_drawn : {false, true}) {
    for (const bool with_base : {false, true}) print_rotor(options, is_drawn, with_base);
  }
  fmt::print(
      "# steady: damping of the structure %, rms of the line where the force acts over that of the roof in the mode "
      "beside, records; verdict on the line: "
      "{};\n"
      "#   true modes, of them right, called harmonic; in the same records without the line: right, called harmonic;\n"
      "#   mode beside the line: found; error of f %: rms, worst; against the record without the line %: rms, worst\n"
      "# rotor-drawn, steady-drawn: the same with camera, structure and noise drawn\n",
      verdict_names());
  for (const SteadyCase& which : {SteadyCase{0.01, 1.0}, SteadyCase{0.01, 0.3}, SteadyCase{0.003, 1.0},
                                  SteadyCase{0.0, 1.0}, SteadyCase{0.0, 0.3}}) {
    print_steady(options, which);
  }
}

}  // namespace tools

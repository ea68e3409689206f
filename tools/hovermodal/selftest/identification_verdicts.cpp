// What is no mode: the camera's own motion and vibration, and steady forces.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/simulation/random_stream.h"
#include "tools/hovermodal/selftest/identification.h"
#include "tools/hovermodal/selftest/identification_match.h"
#include "tools/hovermodal/selftest/identification_parallel.h"
#include "tools/hovermodal/selftest/identification_scene.h"

namespace tools {
namespace {

using core::Mode;
using core::Verdict;
using core::simulation::Scene;
using core::simulation::TrueMode;
using Shaken = StoreysSetup::Shaken;

constexpr double kMaxFrequency_hz = 20.0;
constexpr std::array kVerdicts{Verdict::kStructural, Verdict::kAmbiguous, Verdict::kCameraMotion,
                               Verdict::kInputPeak,  Verdict::kHarmonic,  Verdict::kNumerical};
using Counts = std::array<int, kVerdicts.size() + 1>;  // the last: nothing there

std::size_t place(Verdict verdict) {
  return static_cast<std::size_t>(std::find(kVerdicts.begin(), kVerdicts.end(), verdict) - kVerdicts.begin());
}

std::string verdict_names() {
  std::string names;
  for (const Verdict verdict : kVerdicts) names += fmt::format("{}, ", core::to_string(verdict));
  return names + "nothing found";
}

std::string columns(const Counts& counts) {
  std::string text;
  for (const int n : counts) text += fmt::format("\t{}", n);
  return text;
}

std::vector<Mode> all_poles(const core::ModalEstimate& estimate) {
  std::vector<Mode> poles = estimate.modes;
  poles.insert(poles.end(), estimate.rejected.begin(), estimate.rejected.end());
  return poles;
}

double uniform(std::uint64_t seed, const char* name, double low, double high) {
  return low + (high - low) * core::simulation::RandomStream(seed, name).uniform();
}

// The default hover, and rotors between 60 and 180 Hz whose line wanders: 0.1 px of yaw, as much of roll at the ends of
// the image.
Scene flown_scene(Shaken shaken, std::uint64_t seed) {
  StoreysSetup setup{.shaken = shaken, .rate_hz = 25.0, .row_span = 0.8};
  Scene scene = storeys_scene(setup, seed);
  scene.hover = {};
  scene.camera.exposure_s = 0.002;
  scene.rotor.frequency_hz = uniform(seed, "rotor_rate", 60.0, 180.0);
  scene.rotor.yaw_rms_rad = 5e-5;
  scene.rotor.pitch_rms_rad = 5e-5;
  scene.rotor.roll_rms_rad = 2e-4;
  return scene;
}

}  // namespace

void print_null(const IdentificationOptions& options) {
  fmt::print("# null: channels, records; records with a pole called: {}\n", verdict_names());
  for (const bool with_base : {false, true}) {
    const auto estimates = for_each_seed(options.n_seeds, options.n_threads, [&](std::uint64_t seed) {
      return identify_record(image_record(flown_scene(Shaken::kNothing, seed), with_base), kMaxFrequency_hz);
    });
    Counts records{};
    for (const core::ModalEstimate& estimate : estimates) {
      Counts poles{};
      for (const Mode& mode : all_poles(estimate)) ++poles[place(mode.verdict)];
      for (std::size_t i = 0; i < kVerdicts.size(); ++i) records[i] += poles[i] > 0 ? 1 : 0;
      records.back() += estimate.modes.empty() && estimate.rejected.empty() ? 1 : 0;
    }
    fmt::print("null\t{}\t{}{}\n", with_base ? "floors-and-base" : "floors", estimates.size(), columns(records));
  }
}

namespace {

// What was said of true modes.
struct TrueModes {
  int n = 0, right = 0, called_harmonic = 0, called_camera = 0;

  void add(const core::ModalEstimate& estimate, const std::vector<TrueMode>& truth, const Match& match,
           const std::vector<core::ChannelInfo>& channels) {
    for (std::size_t r = 0; r < truth.size(); ++r) {
      ++n;
      right += match.modes[r].as == Found::As::kRight ? 1 : 0;
      if (match.modes[r].as != Found::As::kAbsent) continue;
      for (const Mode& mode : estimate.rejected) {
        const double f = apparent_hz(truth[r].frequency_hz, estimate.rate_hz);
        const bool same = std::abs(mode.apparent_hz / f - 1.0) < 0.015 && shape_mac(truth[r], mode, channels) > 0.9;
        if (same && mode.verdict == Verdict::kHarmonic) ++called_harmonic;
        if (same && mode.verdict == Verdict::kCameraMotion) ++called_camera;
      }
    }
  }
};

// The gravest of the verdicts on what a wandering line left: a pole within 1 Hz (3 sigma) that is no true mode.
std::size_t worst_near(const core::ModalEstimate& estimate, const Match& match, double line_hz) {
  std::size_t worst = kVerdicts.size();
  for (const Mode& mode : all_poles(estimate)) {
    const bool is_true = std::any_of(match.modes.begin(), match.modes.end(), [&](const Found& found) {
      return found.as == Found::As::kRight && found.mode.apparent_hz == mode.apparent_hz;
    });
    if (!is_true && std::abs(mode.apparent_hz - line_hz) < 1.0) worst = std::min(worst, place(mode.verdict));
  }
  return worst;
}

struct Judged {
  core::ModalEstimate estimate;
  Match match;
  std::vector<core::ChannelInfo> channels;
};

void print_rotor(const IdentificationOptions& options, bool with_base) {
  const std::vector<TrueMode> truth = modes_of(flown_scene(Shaken::kModalParts, 1).structure);
  const auto records = for_each_seed(options.n_seeds, options.n_threads, [&](std::uint64_t seed) {
    const Record record = image_record(flown_scene(Shaken::kModalParts, seed), with_base);
    Judged judged{identify_record(record, kMaxFrequency_hz), {}, record.channels};
    judged.match = match_modes(judged.estimate, truth, record.channels);
    return judged;
  });
  Counts counts{};
  TrueModes modes;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Scene scene = flown_scene(Shaken::kModalParts, i + 1);
    const double line_hz = apparent_hz(scene.rotor.frequency_hz, scene.camera.rate_hz);
    ++counts[worst_near(records[i].estimate, records[i].match, line_hz)];
    modes.add(records[i].estimate, truth, records[i].match, records[i].channels);
  }
  fmt::print("rotor\t{}\t{}{}\t{}\t{}\t{}\t{}\n", with_base ? "floors-and-base" : "floors", records.size(),
             columns(counts), modes.n, modes.right, modes.called_harmonic, modes.called_camera);
}

struct SteadyCase {
  double damping_ratio;
  double line_share;  // rms of the line where the force acts, over that of the roof in the mode beside it
};

// A steady force on a floor, 2 to 6 % of the frequency beside one mode after the other.
struct SteadyLine {
  std::size_t mode;
  double frequency_hz, reach_hz;  // poles within reach are taken for the line
};

SteadyLine steady_line(std::uint64_t seed) {
  SteadyLine line{static_cast<std::size_t>(seed) % kStoreys, 0.0, 0.0};
  const double mode_hz = storey_frequencies_hz()[line.mode];
  const double aside = uniform(seed, "line_aside", 0.02, 0.06) * (uniform(seed, "line_side", 0.0, 1.0) < 0.5 ? -1 : 1);
  line.frequency_hz = mode_hz * (1.0 + aside);
  line.reach_hz = std::min(0.05, 0.4 * std::abs(aside) * mode_hz);
  return line;
}

Scene steady_scene(const SteadyCase& which, std::uint64_t seed, bool with_line) {
  StoreysSetup setup{
      .shaken = Shaken::kModalParts, .duration_s = 600.0, .rate_hz = 25.0, .damping_ratio = which.damping_ratio};
  Scene scene = storeys_scene(setup, seed);
  const int body = 1 + static_cast<int>(seed / kStoreys % kStoreys);
  const SteadyLine line = steady_line(seed);
  const double line_rms_px = which.line_share * kModalParts[line.mode] * setup.roof_rms_px;
  if (with_line) scene.excitation.harmonics = {{body, line.frequency_hz, line_rms_px}};
  return scene;
}

struct SteadyOutcome {
  Judged with, without;
  std::size_t line = kVerdicts.size();  // verdict on it
};

SteadyOutcome judge_steady(const SteadyCase& which, std::uint64_t seed, const std::vector<TrueMode>& truth) {
  SteadyOutcome outcome;
  for (const bool with_line : {true, false}) {
    const Record record = structure_record(steady_scene(which, seed, with_line), false);
    Judged& judged = with_line ? outcome.with : outcome.without;
    judged = {identify_record(record, kMaxFrequency_hz), {}, record.channels};
    judged.match = match_modes(judged.estimate, truth, record.channels);
  }
  const SteadyLine line = steady_line(seed);
  double nearest = line.reach_hz;
  for (const Mode& mode : all_poles(outcome.with.estimate)) {
    const double off = std::abs(mode.apparent_hz - apparent_hz(line.frequency_hz, outcome.with.estimate.rate_hz));
    if (off < nearest) nearest = off, outcome.line = place(mode.verdict);
  }
  return outcome;
}

void print_steady(const IdentificationOptions& options, const SteadyCase& which) {
  const std::vector<TrueMode> truth = modes_of(steady_scene(which, 1, false).structure);
  const auto records = for_each_seed(options.n_seeds, options.n_threads,
                                     [&](std::uint64_t seed) { return judge_steady(which, seed, truth); });
  Counts counts{};
  TrueModes with, without;
  std::vector<double> shift, error;  // of the mode beside the line, %
  for (std::size_t i = 0; i < records.size(); ++i) {
    const SteadyOutcome& record = records[i];
    ++counts[record.line];
    with.add(record.with.estimate, truth, record.with.match, record.with.channels);
    without.add(record.without.estimate, truth, record.without.match, record.without.channels);
    const std::size_t r = steady_line(i + 1).mode;
    const Found &a = record.with.match.modes[r], &b = record.without.match.modes[r];
    if (a.as != Found::As::kRight) continue;
    error.push_back(1e2 * (a.mode.frequency_hz / truth[r].frequency_hz - 1.0));
    if (b.as == Found::As::kRight) shift.push_back(1e2 * (a.mode.frequency_hz / b.mode.frequency_hz - 1.0));
  }
  const Statistics s = statistics(shift), e = statistics(error);
  fmt::print("steady\t{:.1f}\t{:.1f}\t{}{}\t{}\t{}\t{}\t{}\t{}\t{}\t{:.4f}\t{:.4f}\t{:.4f}\t{:.4f}\n",
             1e2 * which.damping_ratio, which.line_share, records.size(), columns(counts), with.n, with.right,
             with.called_harmonic, without.right, without.called_harmonic, e.n, e.rms, std::abs(e.worst), s.rms,
             std::abs(s.worst));
}

}  // namespace

void print_harmonics(const IdentificationOptions& options) {
  fmt::print(
      "# rotor: channels, records; records by the gravest verdict on what the line left: {};\n"
      "#   true modes, of them right, called harmonic, called camera motion\n",
      verdict_names());
  for (const bool with_base : {false, true}) print_rotor(options, with_base);
  fmt::print(
      "# steady: damping of the structure %, rms of the line where the force acts over that of the roof in the mode "
      "beside, records; verdict on the line: "
      "{};\n"
      "#   true modes, of them right, called harmonic; in the same records without the line: right, called harmonic;\n"
      "#   mode beside the line: found; error of f %: rms, worst; against the record without the line %: rms, worst\n",
      verdict_names());
  for (const SteadyCase& which : {SteadyCase{0.01, 1.0}, SteadyCase{0.01, 0.3}, SteadyCase{0.003, 1.0}}) {
    print_steady(options, which);
  }
}

}  // namespace tools

// Motion that is no mode: the camera's own motion and vibration.
#include "tools/validate/identification_verdicts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/simulation/random_stream.h"
#include "tools/validate/identification.h"
#include "tools/validate/identification_parallel.h"
#include "tools/validate/identification_scene.h"
#include "tools/validate/recorded_hover.h"

namespace tools {

using core::Mode;
using core::Verdict;
using core::simulation::Scene;
using core::simulation::TrueMode;
using Shaken = StoreysSetup::Shaken;

std::size_t place_of(Verdict verdict) {
  return static_cast<std::size_t>(std::find(kVerdicts.begin(), kVerdicts.end(), verdict) - kVerdicts.begin());
}

std::string verdict_names() {
  std::string names;
  for (const Verdict verdict : kVerdicts) names += fmt::format("{}, ", core::to_string(verdict));
  return names + "nothing found";
}

std::string columns(const VerdictCounts& counts) {
  std::string text;
  for (const int n : counts) text += fmt::format("\t{}", n);
  return text;
}

std::vector<Mode> all_poles(const core::ModalEstimate& estimate) {
  std::vector<Mode> poles = estimate.modes;
  poles.insert(poles.end(), estimate.rejected.begin(), estimate.rejected.end());
  return poles;
}

double drawn_between(std::uint64_t seed, const char* name, double low, double high) {
  return low + (high - low) * core::simulation::RandomStream(seed, name).uniform();
}

Judged judge_record(const Record& record, double max_frequency_hz, std::vector<TrueMode> truth) {
  Judged judged{identify_record(record, max_frequency_hz), {}, record.channels, std::move(truth)};
  judged.match = match_modes(judged.estimate, judged.truth, record.channels);
  return judged;
}

void TrueModes::add(const Judged& record) {
  for (std::size_t r = 0; r < record.truth.size(); ++r) {
    ++n;
    right += record.match.modes[r].as == Found::As::kRight ? 1 : 0;
    if (record.match.modes[r].as != Found::As::kAbsent) continue;
    for (const Mode& mode : record.estimate.rejected) {
      const double f = apparent_hz(record.truth[r].frequency_hz, record.estimate.rate_hz);
      const bool same =
          std::abs(mode.apparent_hz / f - 1.0) < 0.015 && shape_mac(record.truth[r], mode, record.channels) > 0.9;
      if (same && mode.verdict == Verdict::kHarmonic) ++called_harmonic;
      if (same && mode.verdict == Verdict::kCameraMotion) ++called_camera;
    }
  }
}

namespace {

constexpr double kFlightScale = 0.25;  // of the recorded hover: 2 m away, indoors

struct FlownCase {
  Shaken shaken;
  bool is_drawn;       // camera, structure and noise
  std::string flight;  // the recorded hover; empty = the hover model
};

// A hovering camera, and rotors between 60 and 180 Hz whose spectral line wanders: 0.1 px of yaw, and the same of roll
// at the ends of the image.
Scene flown_scene(const FlownCase& which, std::uint64_t seed) {
  StoreysSetup setup{.shaken = which.shaken, .rate_hz = 25.0, .row_span = 0.8};
  if (which.is_drawn) setup = drawn_storeys(setup, seed);
  Scene scene = storeys_scene(setup, seed);
  scene.hover = {};
  if (!which.flight.empty()) {
    constexpr double kGimbalRms_rad = 0.022 / 57.29577951308232;
    scene.hover.x_rms_mm = scene.hover.y_rms_mm = scene.hover.z_rms_mm = 0.0;
    scene.hover.pitch_rms_rad = scene.hover.yaw_rms_rad = scene.hover.roll_rms_rad = kGimbalRms_rad;
    scene.flight = recorded_hover(which.flight, kFlightScale, seed, scene.duration_s);
  }
  scene.camera.exposure_s = 0.002;
  scene.rotor.frequency_hz = drawn_between(seed, "rotor_rate", 60.0, 180.0);
  scene.rotor.yaw_rms_rad = 5e-5;
  scene.rotor.pitch_rms_rad = 5e-5;
  scene.rotor.roll_rms_rad = 2e-4;
  return scene;
}

const char* channels_of(bool with_base) { return with_base ? "floors-and-base" : "floors"; }

void print_null_case(const IdentificationOptions& options, bool is_drawn, bool with_base) {
  const auto estimates = for_each_seed(options, [&](std::uint64_t seed) {
    const Scene scene = flown_scene({Shaken::kNothing, is_drawn, options.flight}, seed);
    return identify_record(image_record(scene, with_base), fold_limit_hz(scene.camera.rate_hz));
  });
  VerdictCounts records{};
  std::vector<double> apparent;
  for (const core::ModalEstimate& estimate : estimates) {
    VerdictCounts poles{};
    for (const Mode& mode : all_poles(estimate)) {
      ++poles[place_of(mode.verdict)];
      apparent.push_back(mode.apparent_hz);
    }
    for (std::size_t i = 0; i < kVerdicts.size(); ++i) records[i] += poles[i] > 0 ? 1 : 0;
    records.back() += estimate.modes.empty() && estimate.rejected.empty() ? 1 : 0;
  }
  const Statistics hz = statistics(apparent);
  fmt::print("null{}\t{}\t{}{}\t{}\t{:.4f}\n", is_drawn ? "-drawn" : "", channels_of(with_base), estimates.size(),
             columns(records), hz.n, hz.median);
}

}  // namespace

void print_null(const IdentificationOptions& options) {
  fmt::print(
      "# null: channels, records; records with a pole called: {}; poles in all, median of their apparent frequency, "
      "Hz\n"
      "# null-drawn: the same with camera and noise drawn\n",
      verdict_names());
  for (const bool is_drawn : {false, true}) {
    for (const bool with_base : {false, true}) print_null_case(options, is_drawn, with_base);
  }
}

namespace {

// The most serious verdict on a pole caused by a wandering line: within 1 Hz (3 sigma) of it and no true mode.
std::size_t worst_near(const Judged& record, double line_hz) {
  std::size_t worst = kVerdicts.size();
  for (const Mode& mode : all_poles(record.estimate)) {
    const auto& found_modes = record.match.modes;
    const bool is_true = std::any_of(found_modes.begin(), found_modes.end(), [&](const Found& found) {
      return found.as == Found::As::kRight && found.mode.apparent_hz == mode.apparent_hz;
    });
    if (!is_true && std::abs(mode.apparent_hz - line_hz) < 1.0) worst = std::min(worst, place_of(mode.verdict));
  }
  return worst;
}

struct RotorRecord {
  Judged judged;
  std::size_t line;  // verdict on it
};

}  // namespace

void print_rotor(const IdentificationOptions& options, bool is_drawn, bool with_base) {
  const auto records = for_each_seed(options, [&](std::uint64_t seed) {
    const Scene scene = flown_scene({Shaken::kModalParts, is_drawn, {}}, seed);
    Judged judged =
        judge_record(image_record(scene, with_base), fold_limit_hz(scene.camera.rate_hz), modes_of(scene.structure));
    const std::size_t line = worst_near(judged, apparent_hz(scene.rotor.frequency_hz, scene.camera.rate_hz));
    return RotorRecord{std::move(judged), line};
  });
  VerdictCounts counts{};
  TrueModes modes;
  for (const RotorRecord& record : records) {
    ++counts[record.line];
    modes.add(record.judged);
  }
  fmt::print("rotor{}\t{}\t{}{}\t{}\t{}\t{}\t{}\n", is_drawn ? "-drawn" : "", channels_of(with_base), records.size(),
             columns(counts), modes.n, modes.right, modes.called_harmonic, modes.called_camera);
}

}  // namespace tools

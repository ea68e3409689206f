// A bridge deck that moves vertically, filmed with the image along it and with the camera rotated by 90 degrees.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "core/planning/hover_plan.h"
#include "tools/validate/geometry.h"
#include "tools/validate/geometry_score.h"

namespace tools {
namespace {

constexpr int kPlaces = 8;
constexpr double kHighest_hz = 22.0;  // highest frequency searched: as the plan advises, and below the alias of 6.4 Hz
constexpr double kSpan_mm = 40.0e3, kDistance_mm = 45.0e3, kRate_hz = 30.0, kReadout_ms = 23.0;
constexpr double kFocalUpright_px = 1800.0, kFocalTurned_px = 1000.0;
const std::vector<double> kFrequencies_hz{2.1, 6.4, 17.2, 19.8};  // the last two above half the frame rate

double place_share(int body) { return static_cast<double>(body) / (kPlaces + 1); }

// Half sines of a beam between its supports.
double shape(std::size_t mode, int body) {
  return std::sin(std::numbers::pi * static_cast<double>(mode + 1) * place_share(body));
}

std::string structure_yaml() {
  std::string frequencies, shapes;
  for (std::size_t m = 0; m < kFrequencies_hz.size(); ++m) {
    frequencies += fmt::format("{}{}", m > 0 ? ", " : "", kFrequencies_hz[m]);
    shapes += m > 0 ? ", [" : "[";
    for (int body = 1; body <= kPlaces; ++body) shapes += fmt::format("{}{:.9f}", body > 1 ? ", " : "", shape(m, body));
    shapes += "]";
  }
  return fmt::format(
      "structure:\n  type: modes\n  axis: y\n  frequency_hz: [{}]\n  shapes: [{}]\n  damping: {{ratio: "
      "[0.008]}}\n",
      frequencies, shapes);
}

std::string plates_yaml() {
  std::string out = "plates:\n";
  for (int body = 0; body <= kPlaces; ++body) {
    const double x_mm = body == 0 ? -0.5 * kSpan_mm - 1200.0 : kSpan_mm * (place_share(body) - 0.5);
    out += fmt::format("  - {{name: {}, centre_mm: [{:.3f}, 0, {}], size_mm: [2000, 900]}}\n",
                       body == 0 ? "base" : fmt::format("deck{}", body), x_mm, kDistance_mm);
  }
  return out;
}

FigureCase deck_case(bool turned) {
  FigureCase which{"deck", turned ? "turned" : "landscape", {}, 300.0, 2, {{"ours", {}}, {"paper", {"method=paper"}}}};
  which.setup.scene =
      "preset: deck\n" + structure_yaml() + plates_yaml() +
      fmt::format("camera: {{rate_hz: {}, readout_ms: {}, alpha_px: {}, attitude_deg: [0, 0, {}]}}\n", kRate_hz,
                  kReadout_ms, turned ? kFocalTurned_px : kFocalUpright_px, turned ? 90 : 0) +
      "hover: {x_rms_mm: 0, y_rms_mm: 0, z_rms_mm: 0, pitch_rms_deg: 0.022, yaw_rms_deg: 0.022, roll_rms_deg: 0.022}\n"
      "excitation: {base: 0, forces: 1, rms_mm: 3, band_hz: [0.5, 24]}\n";
  which.setup.configuration = {"identification.max_frequency_hz=22", "spectrum.segment=1024",
                               "identification.period=10000"};
  which.setup.flight_scale = 1.0;
  which.setup.ground_rests = true;
  return which;
}

const char* words(core::planning::FoldOutlook outlook) {
  using enum core::planning::FoldOutlook;
  switch (outlook) {
    case kDirect:
      return "direct";
    case kResolved:
      return "resolved";
    case kAmbiguous:
      return "ambiguous";
    case kNoDelays:
      return "ambiguous (no delays)";
  }
  return "";
}

core::planning::HoverPlan plan(const core::simulation::Scene& scene, bool turned) {
  core::planning::PlanInput input;
  input.kind = core::planning::StructureKind::kBeam;
  input.axis = core::planning::LongAxis::kHorizontal;
  input.length_mm = kSpan_mm;
  for (int body = 1; body <= kPlaces; ++body) input.positions.push_back(place_share(body));
  for (std::size_t m = 0; m < kFrequencies_hz.size(); ++m) {
    core::planning::PlannedMode mode{
        .frequency_hz = kFrequencies_hz[m], .damping_ratio = 0.008, .rms_mm = {}, .shape = {}};
    for (int body = 1; body <= kPlaces; ++body) mode.shape.push_back(shape(m, body));
    input.modes.push_back(mode);
  }
  input.distance_mm = scene.plates.front().z_mm;
  input.camera.focal_px = scene.camera.alpha_px;
  input.camera.rate_hz = scene.camera.rate_hz;
  input.camera.readout_s = scene.camera.readout_s;
  if (turned) input.camera = core::planning::turned(input.camera);
  return core::planning::make_plan(input);
}

// Results for one mode, or for all modes with the same outlook in the plan.
struct ModeCount {
  int n = 0, found = 0, ambiguous = 0, wrong = 0;
  void add(const ModeScore& mode) {
    ++n;
    found += mode.found ? 1 : 0;
    ambiguous += mode.ambiguous ? 1 : 0;
    wrong += mode.wrong ? 1 : 0;
  }
};

// [record]
using Plans = std::vector<core::planning::HoverPlan>;

Plans plans_of(const FigureCase& which, const GeometryOptions& options, bool turned) {
  Plans plans;
  for (int i = 0; i < options.n_seeds; ++i) {
    const auto seed = static_cast<std::uint64_t>(options.first_seed + i);
    plans.push_back(plan(flight_job(which.setup, seed, which.duration_s, options).scene(), turned));
  }
  return plans;
}

// By mode and outlook: if all records have the same camera, one line per mode.
void print_modes(const FigureCase& which, const CaseScores& scores, const Plans& plans) {
  for (std::size_t w = 0; w < scores.size(); ++w) {
    for (std::size_t m = 0; m < kFrequencies_hz.size(); ++m) {
      std::map<std::string, ModeCount> counts;
      for (std::size_t i = 0; i < plans.size(); ++i) {
        counts[words(plans[i].modes[m].place.outlook)].add(scores[w][i].modes[m]);
      }
      for (const auto& [outlook, count] : counts) {
        fmt::print("{}-mode\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\n", which.figure, which.name, which.ways[w].name,
                   kFrequencies_hz[m], outlook, count.n, count.found, count.ambiguous, count.wrong);
      }
    }
  }
}

}  // namespace

void print_deck(const GeometryOptions& options) {
  const std::string figure = options.is_drawn ? "deck-drawn" : "deck";
  print_score_columns(figure, "modes 1-2");
  fmt::print("# {}-mode: case, way, true Hz, as planned; records, found, called ambiguous, given a wrong frequency\n",
             figure);
  for (const bool turned : {false, true}) {
    FigureCase which = deck_case(turned);
    if (options.is_drawn) {
      which = drawn_case(which, {.with_structure = false, .segment_s = 1024.0 / kRate_hz, .looks_for_folds = false});
    }
    const CaseScores scores = score_case(which, options);
    for (std::size_t w = 0; w < scores.size(); ++w) {
      print_scores(which.figure, which.name, which.ways[w].name, scores[w], which.n_judged);
    }
    print_modes(which, scores, plans_of(which, options, turned));
  }
}

}  // namespace tools

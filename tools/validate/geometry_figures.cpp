// The flights of the figures.
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tools/validate/geometry.h"
#include "tools/validate/geometry_score.h"
#include "tools/validate/geometry_sensors.h"

namespace tools {
namespace {

const std::string kOnlyTheEnd = "identification.period=10000";  // no intermediate estimates
const std::string kWholeMotion = "scale.only=false", kDistance = "scale.only=true";

// In addition to the recorded path: the aircraft's rotation of 1.1 degrees rms, of which a gimbal leaves 2 %.
constexpr const char* kGimbal =
    "hover: {x_rms_mm: 0, y_rms_mm: 0, z_rms_mm: 0, pitch_rms_deg: 0.022, yaw_rms_deg: 0.022, roll_rms_deg: 0.022}\n";

std::vector<std::string> identification(double max_frequency_hz, int segment) {
  return {fmt::format("identification.max_frequency_hz={}", max_frequency_hz),
          fmt::format("spectrum.segment={}", segment), kOnlyTheEnd};
}

Way paper() { return {"paper", {"method=paper"}}; }

void print_figure(FigureCase which, const DrawnFlight& drawn, const std::string& judged,
                  const GeometryOptions& options) {
  if (options.is_drawn) which = drawn_case(std::move(which), drawn);
  print_score_columns(which.figure, judged);
  print_case(which, options);
}

}  // namespace

// The recorded hover reduced to a quarter: indoors, 2 m away, the scale then changes by some 5 % as in the paper.
FlightSetup paper_flight(double readout_ms) {
  return {fmt::format("preset: paper\ncamera: {{readout_ms: {}}}\n", readout_ms) + kGimbal, identification(20.0, 1024),
          0.25};
}

void print_geometry(const GeometryOptions& options) {
  FigureCase which{"geometry", "paper-300s", paper_flight(), 300.0, 3, {}};
  // Without row delays the alias order of a mode above half the rate cannot be determined: no such modes are drawn.
  const std::string half_rate = "identification.max_frequency_hz=0";
  const std::string no_witness = "spectrum.witness=false";
  which.ways = {{"raw", {"scale.adaptive=false", half_rate, no_witness}, StatedReadout::kNone},
                {"scale", {half_rate, no_witness}, StatedReadout::kNone},
                {"rho-1", {no_witness}, StatedReadout::kWholeFrame},
                paper(),
                {"no-witness", {no_witness}},
                {"ours", {}},
                {"ours-motion", {kWholeMotion}}};
  print_figure(which, {}, "modes 1-3", options);
}

void print_wind(const GeometryOptions& options) {
  // Gaussian rotation of 5/3 degrees rms about each axis, 98 % of it below 0.5 Hz: some 5 degrees at its peaks. The
  // lens is wider than the paper's, so that the structure stays in the view.
  FigureCase which{"wind", "gusts-5deg", {}, 300.0, 3, {}};
  which.setup = {
      "preset: paper\ncamera: {readout_ms: 28, alpha_px: 1200}\n"
      "hover: {x_rms_mm: 0, y_rms_mm: 0, z_rms_mm: 0, pitch_rms_deg: 1.667, yaw_rms_deg: 1.667, roll_rms_deg: 1.667}\n",
      identification(20.0, 1024), 0.25};
  which.ways = {{"ours", {kWholeMotion}},
                {"scale", {kDistance}},
                {"ours-no-background", {kWholeMotion}, StatedReadout::kTrue, false},
                {"ours-attitude", {kWholeMotion}, StatedReadout::kTrue, false, 0.05},
                {"ours-attitude-0.1", {kWholeMotion}, StatedReadout::kTrue, false, 0.1},
                paper()};
  print_figure(which, {.focal_share = 1200.0 / 2100.0}, "modes 1-3", options);
}

void print_low_frequency(const GeometryOptions& options) {
  // A chimney of 46.5 m in the wind, 0.32 Hz, seen from 70 m at 15 fps; static ground in its plane.
  FigureCase which{"low-frequency", "chimney-900s", {}, 900.0, 1, {}};
  which.setup = {
      std::string(
          "preset: cantilever\nstructure: {height_mm: 46500}\nplates: {depth_mm: 70000, width_mm: 2500, "
          "height_mm: 2000}\nbackground: {depth_mm: 150000}\nexcitation: {band_hz: [0.05, 7]}\ncamera: {rate_hz: "
          "15, readout_ms: 20}\ntracks: {points_per_region: 20}\n") +
          kGimbal,
      identification(0.0, 1024), 1.0, true};
  which.ways = {{"ours", {kWholeMotion}}, {"scale", {kDistance}}, paper()};
  print_figure(which, {.with_structure = false, .segment_s = 1024.0 / 15.0, .looks_for_folds = false}, "mode 1",
               options);
}

void print_elevation(const GeometryOptions& options) {
  // The camera is 30 degrees below the middle of the tower, 2 m from it, and aimed at it.
  FigureCase which{"elevation", "30deg", {}, 300.0, 3, {}};
  which.setup = {std::string("preset: paper\ncamera: {readout_ms: 28, alpha_px: 1900, position_mm: [0, 1000, 268], "
                             "attitude_deg: [30, 0, 0]}\n") +
                     kGimbal,
                 identification(20.0, 1024), 0.25};
  which.ways = {paper(), {"one-scale"}};
  if (configuration_knows("scale.points")) {
    which.ways.push_back({.name = "plane-pose", .plane_points = true});
  }
  print_figure(which, {.focal_share = 1900.0 / 2100.0, .elevation_deg = 30.0}, "modes 1-3", options);
}

}  // namespace tools

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "drivers/host/command_line.h"
#include "drivers/storage/csv.h"
#include "drivers/storage/structure_file.h"
#include "drivers/storage/text_file.h"
#include "tools/hovermodal/plan/options.h"

namespace tools {
namespace {

using core::planning::LongAxis;
using core::planning::PlanInput;
using core::planning::StructureKind;

bool given(const drivers::Command& command, const char* name) { return command.given(name); }

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument("plan: " + what); }

void require_positive(double value, const char* name) {
  if (!(value > 0.0)) refuse(fmt::format("{} is {:g}; give a positive number", name, value));
}

std::optional<std::pair<double, double>> parse_sides(std::string_view text) {
  const std::size_t cross = text.find('x');
  if (cross == std::string_view::npos) return std::nullopt;
  const auto first = drivers::parse_number(text.substr(0, cross));
  const auto second = drivers::parse_number(text.substr(cross + 1));
  if (!first || !second || !(*first > 0.0) || !(*second > 0.0)) return std::nullopt;
  return std::pair{*first, *second};
}

std::pair<int, int> image_size(const std::string& text) {
  static const std::map<std::string, std::pair<int, int>> kNamed{{"4320p", {7680, 4320}}, {"2160p", {3840, 2160}},
                                                                 {"1440p", {2560, 1440}}, {"1080p", {1920, 1080}},
                                                                 {"720p", {1280, 720}},   {"540p", {960, 540}}};
  if (const auto named = kNamed.find(text); named != kNamed.end()) return named->second;
  const auto sides = parse_sides(text);
  if (!sides || sides->first > 32768.0 || sides->second > 32768.0) {
    refuse(fmt::format("--image {}: give 4320p, 2160p, 1440p, 1080p, 720p, 540p or WIDTHxHEIGHT in px",
                       drivers::printable(text)));
  }
  return {static_cast<int>(sides->first), static_cast<int>(sides->second)};
}

double focal_px(const drivers::Command& command, const PlanOptions& o, int width_px) {
  const bool px = given(command, "--focal-px"), fov = given(command, "--fov-deg");
  const bool mm = given(command, "--focal-mm"), sensor = given(command, "--sensor-width-mm");
  if (mm != sensor) {
    refuse("--focal-mm and --sensor-width-mm belong together: the focal length in px is their ratio times the width");
  }
  const int n_ways = static_cast<int>(px) + static_cast<int>(fov) + static_cast<int>(mm);
  if (n_ways == 0) refuse("no focal length; give --focal-px, or --focal-mm with --sensor-width-mm, or --fov-deg");
  if (n_ways > 1) {
    refuse(fmt::format("the focal length is given {} times{}{}{}; give it in one way only", n_ways,
                       px ? fmt::format(", --focal-px {:g}", o.focal_px) : "",
                       mm ? fmt::format(", --focal-mm {:g}", o.focal_mm) : "",
                       fov ? fmt::format(", --fov-deg {:g}", o.fov_deg) : ""));
  }
  if (px) return o.focal_px;
  return mm ? core::planning::focal_px_from_mm(o.focal_mm, o.sensor_width_mm, width_px)
            : core::planning::focal_px_from_fov(o.fov_deg, width_px);
}

void set_camera(const drivers::Command& command, const PlanOptions& o, PlanInput& input) {
  static const std::map<std::string, core::ReadoutDirection> kDirections{{"down", core::ReadoutDirection::kDown},
                                                                         {"up", core::ReadoutDirection::kUp},
                                                                         {"left", core::ReadoutDirection::kLeft},
                                                                         {"right", core::ReadoutDirection::kRight}};
  core::planning::PlannedCamera& camera = input.camera;
  std::tie(camera.width_px, camera.height_px) = image_size(o.image);
  camera.focal_px = focal_px(command, o, camera.width_px);
  camera.rate_hz = o.fps;
  camera.readout_s = o.readout_ms * 1e-3;
  camera.exposure_s = o.exposure_ms * 1e-3;
  camera.direction = kDirections.at(o.direction);
  input.distance_mm = o.distance_m * 1e3;
  input.rates_hz = o.rates_hz;
}

void set_structure(const drivers::Command& command, const PlanOptions& o, PlanInput& input) {
  const bool shear = o.structure == "shear";
  input.kind = shear                         ? StructureKind::kShearChain
               : o.structure == "cantilever" ? StructureKind::kCantilever
                                             : StructureKind::kBeam;
  const bool lies = o.axis.empty() ? input.kind == StructureKind::kBeam : o.axis == "horizontal";
  input.axis = lies ? LongAxis::kHorizontal : LongAxis::kVertical;
  if (!shear && (given(command, "--storeys") || given(command, "--storey-mm"))) {
    refuse(fmt::format("--storeys and --storey-mm are of --structure shear; for a {} give --size-m and --regions",
                       o.structure));
  }
  if (shear && given(command, "--regions"))
    refuse("--regions is of --structure cantilever or beam; a shear frame has a region on every floor (--storeys)");
  if (given(command, "--size-m") == given(command, "--storey-mm")) {
    refuse(shear ? "give the size once: --storey-mm (with --storeys), or --size-m" : "give --size-m, height or span");
  }
  const int n_floors = given(command, "--storeys") ? o.storeys : static_cast<int>(o.frequency_hz.size());
  const int n_regions = shear ? n_floors : given(command, "--regions") ? o.regions : 6;
  require_positive(n_regions, shear ? "--storeys" : "--regions");
  input.n_floors = n_floors;
  if (given(command, "--storey-mm")) require_positive(o.storey_mm, "--storey-mm");
  input.length_mm = given(command, "--storey-mm") ? o.storey_mm * n_floors : o.size_m * 1e3;
  input.positions = core::planning::even_positions(input.kind, n_regions);
}

double one_or_each(const std::vector<double>& values, std::size_t i, std::size_t n, const char* name) {
  if (values.size() != 1 && values.size() != n) {
    refuse(fmt::format("{} has {} values for {} frequencies; give one, or one for each", name, values.size(), n));
  }
  return values.size() == 1 ? values.front() : values[i];
}

void set_modes(const PlanOptions& o, PlanInput& input) {
  const std::size_t n = o.frequency_hz.size();
  for (std::size_t i = 0; i < n; ++i) {
    core::planning::PlannedMode mode;
    mode.frequency_hz = o.frequency_hz[i];
    mode.damping_ratio = 0.01 * one_or_each(o.damping_percent, i, n, "--damping-percent");
    if (!o.amplitude_mm.empty()) mode.rms_mm = one_or_each(o.amplitude_mm, i, n, "--amplitude-mm");
    input.modes.push_back(mode);
  }
}

void set_shapes(const std::string& path, PlanInput& input) {
  const drivers::SeriesFile file = drivers::read_series_csv(path);
  const int i_position = file.column("position_mm");
  if (i_position < 0) refuse(path + ": no column position_mm, the region's place from the foot or the left end");
  if (file.columns.size() != input.modes.size() + 1) {
    refuse(fmt::format("{}: {} columns of shapes for {} frequencies; give one for each mode, in their order", path,
                       file.columns.size() - 1, input.modes.size()));
  }
  input.positions.clear();
  for (const double mm : file.columns[static_cast<std::size_t>(i_position)])
    input.positions.push_back(mm / input.length_mm);
  std::size_t i_mode = 0;
  for (std::size_t c = 0; c < file.columns.size(); ++c) {
    if (static_cast<int>(c) != i_position) input.modes[i_mode++].shape = file.columns[c];
  }
}

// The structure file that --structure names, if it names one: `o` then has the ideal kind next to it.
std::optional<core::structure::DeclaredFrame> declared_structure(PlanOptions& o) {
  if (o.structure == "shear" || o.structure == "cantilever" || o.structure == "beam") return std::nullopt;
  const auto read = [&] {
    try {
      return drivers::read_structure(o.structure);
    } catch (const drivers::FileError& error) {
      refuse(fmt::format("--structure: give shear, cantilever, beam, or a structure file: {}", error.what()));
    }
  };
  const core::structure::DeclaredFrame out = read();
  if (!out.model || out.model->sights().empty())
    refuse(o.structure + ": declare regions (name, at_m, direction); a shear frame is planned with --structure shear");
  const auto reach = [&](int axis) {
    double most = 0.0;
    for (const auto& sight : out.model->sights()) most = std::max(most, std::abs(sight.at_m(axis)));
    return most;
  };
  o.structure = reach(2) > reach(0) ? "cantilever" : "beam";
  if (o.frequency_hz.empty()) {
    if (!out.stiffness_over_mass_per_s2)
      refuse(
          "--frequencies: the structure file determines ratios only (stiffness: fitted); give them, or declare known");
    o.frequency_hz = {out.numbering->frequency_hz.begin(), out.numbering->frequency_hz.end()};
  }
  return out;
}

// Its regions and shapes, mode by mode from the lowest.
void set_declared(const core::structure::DeclaredFrame& declared, PlanInput& input) {
  const int axis = input.kind == StructureKind::kBeam ? 0 : 2;
  input.positions.clear();
  for (const auto& sight : declared.model->sights())
    input.positions.push_back(1e3 * sight.at_m(axis) / input.length_mm);
  const Eigen::MatrixXd& shapes = declared.numbering->shapes;
  for (std::size_t r = 0; r < input.modes.size() && static_cast<Eigen::Index>(r) < shapes.cols(); ++r) {
    const Eigen::VectorXd shape = shapes.col(static_cast<Eigen::Index>(r));
    const double largest = shape.cwiseAbs().maxCoeff();
    if (largest > 0.0) input.modes[r].shape = {shape.begin(), shape.end()};
    for (double& component : input.modes[r].shape) component /= largest;
  }
}

void set_points(const drivers::Command& command, const PlanOptions& o, PlanInput& input) {
  input.points_per_region = o.points;
  input.window_px = o.window_px;
  const double named = o.texture == "poor" ? 3.0 : o.texture == "good" ? 16.0 : 8.0;
  core::planning::PointQuality quality;
  quality.noise_grey = o.noise_grey;
  quality.gradient_grey = given(command, "--gradient") ? o.gradient_grey : named;
  quality.window_px = o.window_px;
  input.point_sigma_px =
      given(command, "--point-sigma-px") ? o.point_sigma_px : core::planning::point_sigma_px(quality);
  if (o.region_mm.empty()) return;
  const auto sides = parse_sides(o.region_mm);
  if (!sides) refuse(fmt::format("--region-mm {}: give WIDTHxHEIGHT, e.g. 300x50", drivers::printable(o.region_mm)));
  std::tie(input.region_width_mm, input.region_height_mm) = *sides;
}

}  // namespace

PlanInput plan_input(const drivers::Command& command, const PlanOptions& given_options) {
  PlanOptions o = given_options;
  const auto declared = declared_structure(o);
  if (o.frequency_hz.empty()) refuse("--frequencies: give the expected ones, or a structure file that determines them");
  for (const auto& [name, value] : {std::pair{"--hover-min", o.hover_min}, {"--battery-min", o.battery_min}}) {
    if (given(command, name)) require_positive(value, name);
  }
  require_positive(o.distance_m, "--distance-m");
  PlanInput input;
  set_structure(command, o, input);
  set_modes(o, input);
  set_camera(command, o, input);
  set_points(command, o, input);
  if (declared) set_declared(*declared, input);
  if (!o.shapes_file.empty()) set_shapes(o.shapes_file, input);
  input.relative_sigma_frequency = 0.01 * o.sigma_f_percent;
  input.relative_sigma_damping = 0.01 * o.sigma_zeta_percent;
  input.hover_s = 60.0 * o.hover_min;
  input.battery_s = 60.0 * o.battery_min;
  core::planning::validate(input);
  return input;
}

}  // namespace tools

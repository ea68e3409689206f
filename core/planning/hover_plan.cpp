#include "core/planning/hover_plan.h"

#include <algorithm>
#include <cmath>

#include "core/planning/camera_options.h"
#include "core/planning/check_value.h"
#include "core/planning/hover_time.h"

namespace core::planning {
namespace {

void validate_modes(const PlanInput& input) {
  require(!input.modes.empty() && input.modes.size() <= kMaxModes, "number of modes",
          static_cast<double>(input.modes.size()), "give 1 to 40 frequencies");
  double last_hz = 0.0;
  for (const PlannedMode& mode : input.modes) {
    require_range("frequency of a mode (Hz)", mode.frequency_hz, 1e-3, 1e4);
    require(mode.frequency_hz > last_hz, "frequency of a mode (Hz)", mode.frequency_hz,
            "give them in ascending order, each once: the place in the list is the mode's number");
    last_hz = mode.frequency_hz;
    require_range("damping ratio (0.01 = 1 %)", mode.damping_ratio, 1e-5, 0.5);
    if (mode.rms_mm) require_range("expected amplitude of a mode (mm rms)", *mode.rms_mm, 1e-9, 1e5);
    require(mode.shape.empty() || mode.shape.size() == input.positions.size(), "number of values of a shape",
            static_cast<double>(mode.shape.size()), "give one for every region");
    for (const double value : mode.shape) require_range("value of a shape", value, -1e9, 1e9);
  }
  const bool needs_floors = input.kind == StructureKind::kShearChain && input.modes.front().shape.empty();
  require(!needs_floors || static_cast<int>(input.modes.size()) <= input.n_floors, "number of modes",
          static_cast<double>(input.modes.size()), "a shear chain has one for each floor: give fewer, or shapes");
}

void validate_geometry(const PlanInput& input) {
  require_range("length of the structure (mm)", input.length_mm, 1.0, 1e7);
  require_range("distance (mm)", input.distance_mm, 10.0, 1e7);
  require_range("number of floors", input.n_floors, 1, 200);
  require_range("number of regions", static_cast<double>(input.positions.size()), 1, 200);
  for (const double x : input.positions) require_range("position of a region (1 = the structure's end)", x, 0.0, 1.0);
  for (const double side_mm : {input.region_width_mm, input.region_height_mm})
    require_range("side of a region (mm)", side_mm, 0.0, 1e7);
}

void validate_rates(const PlanInput& input) {
  require_range("number of frame rates to try", static_cast<double>(input.rates_hz.size()), 0, 100);
  for (const double rate_hz : input.rates_hz) require_range("frame rate to try (Hz)", rate_hz, 0.1, 1e5);
}

void validate_record(const PlanInput& input) {
  require_range("noise of a point (px rms)", input.point_sigma_px, 1e-6, 100.0);
  require_range("points per region", input.points_per_region, 1, 100000);
  require_range("tracked patch (px)", input.window_px, 3.0, 1000.0);
  require_range("wanted sigma of f (relative)", input.relative_sigma_frequency, 1e-6, 1.0);
  require_range("wanted sigma of the damping (relative)", input.relative_sigma_damping, 1e-4, 1.0);
  require_range("battery (s)", input.battery_s, 0.0, 1e6);
  require_range("hover time (s)", input.hover_s, 0.0, 1e6);
  constexpr double kLeastFrames = 256.0;
  const double given_s = input.hover_s > 0.0 ? input.hover_s : input.battery_s;
  require(given_s == 0.0 || given_s * input.camera.rate_hz >= kLeastFrames, "hover time (s)", given_s,
          "give at least 256 frames, four of the shortest segments");
}

ModePlan plan_mode(const PlanInput& input, const HoverPlan& plan, const PlannedMode& mode, FoldPlace place) {
  ModePlan out;
  out.place = std::move(place);
  const double f = mode.frequency_hz, zeta = mode.damping_ratio;
  out.half_power_hz = 2.0 * zeta * f;
  out.edge = at_edge(out.place.apparent_hz, out.half_power_hz, input.camera.rate_hz);
  out.in_hover_band = out.place.apparent_hz < kHoverBandHz;
  out.exposure_gain = exposure_gain(f, input.camera.exposure_s);
  const double density = plan.floor.density_mm_per_sqrt_hz;
  out.least_rms_mm = least_rms_mm(kSeenRatio, density, zeta, f, plan.bandwidth_hz, out.exposure_gain);
  if (mode.rms_mm) {
    const double peak = peak_density(*mode.rms_mm * out.exposure_gain, zeta, f, plan.bandwidth_hz);
    out.over_floor_db = 10.0 * std::log10(std::max(peak / (density * density), 1e-30));
  }
  out.seconds_for_frequency = seconds_for_frequency(f, zeta, input.relative_sigma_frequency);
  out.seconds_for_damping = seconds_for_damping(f, zeta, input.relative_sigma_damping);
  out.relative_sigma_frequency = relative_frequency_sigma(f, zeta, plan.hover_s);
  out.relative_sigma_damping = relative_damping_sigma(f, zeta, plan.hover_s);
  return out;
}

// The mode with the smallest zeta f, i.e. the slowest decay.
const PlannedMode& slowest(const PlanInput& input) {
  return *std::min_element(input.modes.begin(), input.modes.end(), [](const PlannedMode& a, const PlannedMode& b) {
    return a.damping_ratio * a.frequency_hz < b.damping_ratio * b.frequency_hz;
  });
}

void plan_time(const PlanInput& input, HoverPlan& plan) {
  constexpr double kLeastSeconds = 30.0;
  plan.needed_s = kLeastSeconds;
  for (const PlannedMode& mode : input.modes) {
    const double f = mode.frequency_hz, zeta = mode.damping_ratio;
    plan.needed_s = std::max({plan.needed_s, seconds_for_frequency(f, zeta, input.relative_sigma_frequency),
                              seconds_for_damping(f, zeta, input.relative_sigma_damping)});
  }
  constexpr double kLeastFrames = 256.0;
  plan.needed_s = std::max(plan.needed_s, kLeastFrames / input.camera.rate_hz);
  plan.hover_s = input.hover_s > 0.0     ? input.hover_s
                 : input.battery_s > 0.0 ? std::min(plan.needed_s, input.battery_s)
                                         : plan.needed_s;
  const PlannedMode& longest = slowest(input);
  plan.segment = segment_length(longest.frequency_hz, longest.damping_ratio, input.camera.rate_hz, plan.hover_s);
  plan.bandwidth_hz = hann_bandwidth_hz(plan.segment, input.camera.rate_hz);
}

}  // namespace

std::vector<double> even_positions(StructureKind kind, int n) {
  require_range("number of regions", n, 1, 200);
  std::vector<double> out;
  const int parts = kind == StructureKind::kBeam ? n + 1 : n;
  for (int i = 1; i <= n; ++i) out.push_back(static_cast<double>(i) / parts);
  return out;
}

void validate(const PlanInput& input) {
  validate(input.camera);
  validate_geometry(input);
  validate_modes(input);
  validate_rates(input);
  validate_record(input);
}

HoverPlan make_plan(const PlanInput& input) {
  validate(input);
  HoverPlan plan;
  plan.mm_per_px = mm_per_px(input.camera, input.distance_mm);
  plan.structure_px = input.length_mm / plan.mm_per_px;
  plan.room_px = room_px(input.camera, input.axis);
  plan.fits = fits(input, input.camera);
  plan.max_frequency_hz = highest_frequency_hz(input);
  const double n_points = independent_points(input.points_per_region, input.region_width_mm / plan.mm_per_px,
                                             input.region_height_mm / plan.mm_per_px, input.window_px);
  plan.floor = noise_floor(input.point_sigma_px, n_points, plan.mm_per_px, input.camera.rate_hz);
  plan_time(input, plan);
  FoldSurvey survey = survey_folds(input, input.camera);
  plan.delay_span_frames = survey.delay_span_frames;
  for (std::size_t i = 0; i < input.modes.size(); ++i)
    plan.modes.push_back(plan_mode(input, plan, input.modes[i], std::move(survey.places[i])));
  plan.overlaps = std::move(survey.overlaps);
  plan.options = camera_options(input);
  plan.best_option = best_option(plan.options);
  return plan;
}

}  // namespace core::planning

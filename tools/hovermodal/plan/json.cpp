#include <nlohmann/json.hpp>

#include "core/planning/hover_time.h"
#include "drivers/storage/json.h"
#include "drivers/storage/json_values.h"
#include "tools/hovermodal/plan/words.h"

namespace tools {

using core::planning::HoverPlan;
using core::planning::PlanInput;
using Json = nlohmann::ordered_json;
using drivers::or_null;

namespace {

Json mode_json(const PlanInput& input, const HoverPlan& plan, std::size_t i) {
  const core::planning::ModePlan& mode = plan.modes[i];
  Json overlaps = Json::array();
  for (const auto& o : plan.overlaps) {
    if (o.first == i) overlaps.push_back(o.second + 1);
    if (o.second == i) overlaps.push_back(o.first + 1);
  }
  return {{"mode", i + 1},
          {"frequency_hz", input.modes[i].frequency_hz},
          {"damping_ratio", input.modes[i].damping_ratio},
          {"apparent_hz", mode.place.apparent_hz},
          {"fold_n", mode.place.n},
          {"fold", to_text(mode.place.outlook)},
          {"fold_margin", or_null(mode.place.margin)},
          {"rivals_hz", mode.place.rivals_hz},
          {"half_power_hz", mode.half_power_hz},
          {"overlaps_modes", overlaps},
          {"at_edge", mode.edge},
          {"in_hover_band", mode.in_hover_band},
          {"exposure_gain", mode.exposure_gain},
          {"least_rms_mm", mode.least_rms_mm},
          {"expected_rms_mm", or_null(input.modes[i].rms_mm)},
          {"over_floor_db", or_null(mode.over_floor_db)},
          {"minutes_for_frequency", mode.seconds_for_frequency / 60.0},
          {"minutes_for_damping", mode.seconds_for_damping / 60.0},
          {"sigma_frequency_relative", mode.relative_sigma_frequency},
          {"sigma_damping_relative", mode.relative_sigma_damping}};
}

const char* obstacle_text(core::planning::Obstacle obstacle) noexcept {
  switch (obstacle) {
    case core::planning::Obstacle::kNone:
      return "none";
    case core::planning::Obstacle::kReadoutTooLong:
      return "readout longer than a frame";
    case core::planning::Obstacle::kExposureTooLong:
      return "exposure longer than a frame";
  }
  return "";
}

Json option_json(const core::planning::CameraOption& option) {
  Json out{{"rate_hz", option.rate_hz},
           {"turned", option.turned},
           {"obstacle", obstacle_text(option.obstacle)},
           {"fits", option.fits}};
  if (option.obstacle != core::planning::Obstacle::kNone) return out;
  out["folded"] = option.n_folded;
  out["open"] = option.n_open;
  out["overlapping"] = option.n_overlaps;
  out["merging"] = option.n_merging;
  out["hidden"] = option.n_hidden;
  out["least_margin"] = or_null(option.least_margin);
  out["penalty"] = option.penalty;
  return out;
}

Json camera_json(const PlanInput& input) {
  const core::planning::PlannedCamera& camera = input.camera;
  return {{"width_px", camera.width_px},
          {"height_px", camera.height_px},
          {"focal_px", camera.focal_px},
          {"rate_hz", camera.rate_hz},
          {"readout_ms", 1e3 * camera.readout_s},
          {"readout_direction", to_string(camera.direction)},
          {"exposure_ms", 1e3 * camera.exposure_s},
          {"distance_mm", input.distance_mm}};
}

}  // namespace

std::string plan_json(const PlanInput& input, const HoverPlan& plan) {
  Json out;
  out["camera"] = camera_json(input);
  out["view"] = {{"mm_per_px", plan.mm_per_px},
                 {"structure_px", plan.structure_px},
                 {"room_px", plan.room_px},
                 {"fits", plan.fits},
                 {"delay_span_frames", plan.delay_span_frames}};
  out["noise"] = {{"point_sigma_px", plan.floor.point_sigma_px},
                  {"independent_points", plan.floor.independent_points},
                  {"channel_sigma_mm", plan.floor.channel_sigma_mm},
                  {"density_mm_per_sqrt_hz", plan.floor.density_mm_per_sqrt_hz}};
  out["hover"] = {{"minutes", plan.hover_s / 60.0},
                  {"minutes_needed", plan.needed_s / 60.0},
                  {"battery_minutes", input.battery_s > 0.0 ? Json(input.battery_s / 60.0) : Json(nullptr)},
                  {"method_factor", core::planning::kMethodFactor},
                  {"segment", plan.segment},
                  {"max_frequency_hz", plan.max_frequency_hz}};
  out["modes"] = Json::array();
  for (std::size_t i = 0; i < plan.modes.size(); ++i) out["modes"].push_back(mode_json(input, plan, i));
  out["camera_options"] = Json::array();
  for (const auto& option : plan.options) out["camera_options"].push_back(option_json(option));
  out["best_option"] = plan.best_option;
  out["advice"] = plan_advice(input, plan);
  out["configuration"] = plan_yaml(input, plan);
  return drivers::to_json_text(out).text;
}

}  // namespace tools

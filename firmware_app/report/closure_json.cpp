#include "firmware_app/report/closure_json.h"

#include <nlohmann/json.hpp>
#include <optional>

#include "drivers/storage/json.h"
#include "drivers/storage/json_values.h"

namespace app {
namespace {

using Json = nlohmann::ordered_json;
using drivers::or_null;

Json mode_json(const core::closure::ClosureMode& mode) {
  return {{"mode", mode.number},
          {"frequency_hz", mode.frequency_hz},
          {"damping_ratio", or_null(mode.damping_ratio)},
          {"reference_hz", or_null(mode.reference_hz)},
          {"error_percent", or_null(mode.error_percent)},
          {"heldout_error_percent", or_null(mode.heldout_error_percent)},
          {"sigma_percent", or_null(mode.sigma_percent)},
          {"mac", or_null(mode.mac)}};
}

Json modes_json(const std::vector<core::closure::ClosureMode>& modes) {
  Json out = Json::array();
  for (const auto& mode : modes) out.push_back(mode_json(mode));
  return out;
}

Json step_json(const core::closure::ClosureStep& step) {
  Json parameters = Json::object();
  for (const auto& p : step.parameters)
    parameters[p.name] = {{"value", p.value}, {"sigma", or_null(p.sigma)}, {"unit", p.unit}};
  return {{"effect", step.effect},
          {"kind", step.kind == core::closure::EffectKind::kNamed ? "named" : "latent"},
          {"parameters", parameters},
          {"meaning", step.meaning},
          {"absorbed", step.is_absorbed},
          {"heldout_before", step.heldout_before},
          {"heldout_after", step.heldout_after},
          {"score", step.score},
          {"threshold", step.threshold},
          {"rivals", step.rivals}};
}

}  // namespace

std::string closure_json(const core::closure::ClosureResult& result) {
  Json out;
  out["version"] = 1;
  out["level"] = result.level;
  out["baseline"] = {{"residual_rms", result.baseline_rms}, {"noise_floor", result.noise_floor}, {"unit", result.unit}};
  out["steps"] = Json::array();
  for (const auto& step : result.steps) out["steps"].push_back(step_json(step));
  out["refused"] = Json::array();
  for (const auto& candidate : result.refused) {
    out["refused"].push_back(
        {{"effect", candidate.effect}, {"heldout", candidate.heldout}, {"reason", candidate.refusal}});
  }
  out["unexplained"] = {{"fraction", result.unexplained_fraction}, {"description", result.unexplained}};
  if (!result.noise.empty()) {
    out["noise"] = {{"values", Json::array()}, {"advice", result.noise_advice}};
    for (const auto& value : result.noise)
      out["noise"]["values"].push_back({{"name", value.name}, {"value", value.value}, {"unit", value.unit}});
  }
  out["not_observable"] = Json::array();
  for (const auto& effect : result.not_observable) {
    out["not_observable"].push_back(
        {{"effect", effect.effect}, {"reason", effect.reason}, {"instead", effect.instead}});
  }
  out["modes_before"] = modes_json(result.modes_before);
  out["modes_after"] = modes_json(result.modes_after);
  out["reference_error_before"] = or_null(result.reference_error_before);
  out["reference_error_after"] = or_null(result.reference_error_after);
  out["reference_unit"] = result.reference_unit;
  return drivers::to_json_text(out).text;
}

}  // namespace app

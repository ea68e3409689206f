#include <cmath>
#include <nlohmann/json.hpp>

#include "drivers/storage/json.h"
#include "tools/hovermodal/changes/mode_histories.h"

namespace tools {
namespace {

using core::monitoring::Change;
using core::monitoring::ChangeKind;
using Json = nlohmann::ordered_json;

Json history_json(const ModeHistories& result, const History& history) {
  const Change& change = history.change;
  Json out = Json::object();
  out["tested"] = change.is_tested;
  out["changed"] = change.is_significant;
  if (change.is_tested) {
    out["chance"] = change.chance;
    out["kind"] = change.kind == ChangeKind::kStep ? "step" : "trend";
    out["kind_is_clear"] = change.kind_is_clear;
    out["first_flight_after"] =
        change.kind == ChangeKind::kStep ? Json(result.flights[change.first_flight].name) : Json(nullptr);
    out[change.kind == ChangeKind::kStep ? "size" : "size_per_day"] = change.size;
    out["std"] = change.size_std;
    out["mean"] = change.mean;
    out["scatter"] = change.scatter;
    out["per_kelvin"] = change.per_kelvin_std > 0.0 ? Json(change.per_kelvin) : Json(nullptr);
    out["per_kelvin_std"] = change.per_kelvin_std > 0.0 ? Json(change.per_kelvin_std) : Json(nullptr);
  }
  out["values"] = Json::array();
  for (const auto& value : history.values)
    out["values"].push_back({{"flight", value.flight + 1}, {"value", value.value}, {"std", value.std}});
  return out;
}

Json mode_json(const ModeHistories& result, const ModeHistory& mode) {
  Json out = Json::object();
  out["frequency_hz"] = history_json(result, mode.frequency);
  out["log_damping"] = history_json(result, mode.log_damping);
  out["shape"] = Json::array();
  for (const ModeHistory::Component& one : mode.shape) {
    Json component = {{"channel", one.channel}};
    component.update(history_json(result, one.value));
    out["shape"].push_back(std::move(component));
  }
  return out;
}

}  // namespace

std::string changes_json(const ModeHistories& result) {
  Json out = Json::object();
  out["version"] = 1;
  out["changed"] = result.is_changed();
  out["flights"] = Json::array();
  for (const DatedFlight& flight : result.flights) {
    out["flights"].push_back(
        {{"name", flight.name},
         {"date", flight.date.empty() ? Json(nullptr) : Json(flight.date)},
         {"day", flight.day},
         {"temperature_c", std::isfinite(flight.temperature_c) ? Json(flight.temperature_c) : Json(nullptr)}});
  }
  out["contradicting"] = Json::array();
  for (const auto& one : result.contradicting) {
    out["contradicting"].push_back({{"flight", result.flights[one.flight].name},
                                    {"share", one.share},
                                    {"std", one.std},
                                    {"modes", one.n_modes},
                                    {"all_modes_alike", one.is_common}});
  }
  out["modes"] = Json::array();
  for (const ModeHistory& mode : result.modes) out["modes"].push_back(mode_json(result, mode));
  return drivers::to_json_text(out).text;
}

}  // namespace tools

#include <nlohmann/json.hpp>

#include "drivers/storage/json.h"
#include "drivers/storage/json_values.h"
#include "tools/hovermodal/batch/combine.h"

namespace tools {

namespace {

using Json = nlohmann::ordered_json;
using drivers::or_null;

Json positive_or_null(double value) { return value > 0.0 ? Json(value) : Json(nullptr); }

Json mean_json(const core::WeightedMean& mean) {
  if (mean.n == 0) return nullptr;
  return {{"value", mean.value},
          {"std", positive_or_null(mean.std)},
          {"degrees_of_freedom", positive_or_null(mean.degrees_of_freedom)},
          {"scatter", or_null(mean.scatter)}};
}

Json one_json(const char* what, const Json& which, const core::Mode& mode) {
  return {{what, which},
          {"frequency_hz", mode.frequency_hz},
          {"frequency_std_hz", or_null(mode.frequency_std_hz)},
          {"damping_ratio", mode.damping_ratio},
          {"damping_std", or_null(mode.damping_std)}};
}

Json mode_json(const BatchResult& result, const BatchMode& mode) {
  Json out = Json::object();
  out["frequency_hz"] = mean_json(mode.frequency_hz);
  out["damping_ratio"] = mean_json(mode.damping_ratio);
  out["flights"] = mode.flights.size();
  out["mean_of_flights"] = {{"frequency_hz", mean_json(mode.flights_frequency_hz)},
                            {"damping_ratio", mean_json(mode.flights_damping_ratio)}};
  out["by_view"] = Json::array();
  for (const BatchMode::Of& of : mode.views)
    out["by_view"].push_back(one_json("view", of.index + 1, result.views[of.index].report.estimate.modes[of.i_mode]));
  out["by_flight"] = Json::array();
  for (const BatchMode::Of& of : mode.flights) {
    const FlightResult& flight = result.flights[of.index];
    out["by_flight"].push_back(one_json("flight", flight.name, flight.report.estimate.modes[of.i_mode]));
  }
  return out;
}

Json flight_json(const FlightResult& flight) {
  const core::ModalEstimate& estimate = flight.report.estimate;
  Json out = {{"name", flight.name}, {"kind", to_string(flight.kind)}};
  out["failure"] = flight.failure.empty() ? Json(nullptr) : Json(flight.failure);
  out["contradiction"] = flight.contradiction.empty() ? Json(nullptr) : Json(flight.contradiction);
  out["view"] = flight.failure.empty() ? Json(flight.i_view + 1) : Json(nullptr);
  out["duration_s"] = flight.failure.empty() ? Json(estimate.duration_s) : Json(nullptr);
  out["modes"] = estimate.modes.size();
  return out;
}

}  // namespace

std::string batch_json(const BatchResult& result) {
  Json out = Json::object();
  out["version"] = 1;
  out["modes"] = Json::array();
  for (const BatchMode& mode : result.modes) out["modes"].push_back(mode_json(result, mode));
  out["unsettled"] = Json::array();
  for (const BatchMode& mode : result.unsettled) out["unsettled"].push_back(mode_json(result, mode));
  out["views"] = Json::array();
  for (const ViewResult& view : result.views) {
    Json names = Json::array();
    for (const std::size_t f : view.flights) names.push_back(result.flights[f].name);
    out["views"].push_back({{"flights", std::move(names)},
                            {"why", view.why.empty() ? Json(nullptr) : Json(view.why)},
                            {"duration_s", view.report.estimate.duration_s},
                            {"segments", view.report.estimate.n_segments},
                            {"channels", view.report.channel_names}});
  }
  out["flights"] = Json::array();
  for (const FlightResult& flight : result.flights) out["flights"].push_back(flight_json(flight));
  return drivers::to_json_text(out).text;
}

}  // namespace tools

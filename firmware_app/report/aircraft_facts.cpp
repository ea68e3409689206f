#include "firmware_app/report/aircraft_facts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <optional>
#include <vector>

namespace app {
namespace {

using Json = nlohmann::ordered_json;

// The number of that key; `least` to `most`, or refused.
double number_in(const JsonFields& file, const Json& object, const char* key, double least, double most) {
  const std::optional<double> value = file.optional_number(object, key);
  if (!value || !(*value >= least && *value <= most))
    file.refuse(fmt::format("aircraft.{}", key), fmt::format("is no number from {:g} to {:g}", least, most));
  return *value;
}

core::MotorRate motor_of(const JsonFields& file, const Json& object) {
  return {static_cast<int>(number_in(file, object, "number", 1.0, core::AircraftState::kMotors)),
          number_in(file, object, "hz", core::kLeastTurns_hz, core::kMostTurns_hz),
          number_in(file, object, "spread_hz", 0.0, core::kMostTurns_hz)};
}

std::string place_words(const core::AircraftSummary::Place& place) {
  std::string out =
      fmt::format("{:.6f} {}, {:.6f} {}", std::abs(place.latitude_deg), place.latitude_deg < 0 ? "S" : "N",
                  std::abs(place.longitude_deg), place.longitude_deg < 0 ? "W" : "E");
  if (place.above_home_m) out += fmt::format(", {:.1f} m above home", *place.above_home_m);
  return out;
}

}  // namespace

Json aircraft_json(const core::AircraftSummary& aircraft) {
  Json out = Json::object();
  out["states"] = aircraft.n_states;
  out["motors"] = Json::array();
  for (const core::MotorRate& motor : aircraft.motors)
    out["motors"].push_back({{"number", motor.number}, {"hz", motor.hz}, {"spread_hz", motor.spread_hz}});
  out["place"] = nullptr;
  if (const auto& place = aircraft.place) {
    out["place"] = {{"latitude_deg", place->latitude_deg}, {"longitude_deg", place->longitude_deg}};
    out["place"]["above_home_m"] = place->above_home_m ? Json(*place->above_home_m) : Json(nullptr);
  }
  out["wind"] = nullptr;
  if (const auto& wind = aircraft.wind) out["wind"] = {{"m_s", wind->m_s}, {"from_deg", wind->from_deg}};
  return out;
}

core::AircraftSummary aircraft_of(const Json& object, const JsonFields& file) {
  core::AircraftSummary out;
  out.n_states = file.count(object, "states");
  if (const Json* motors = JsonFields::find(object, "motors")) {
    if (!motors->is_array()) file.refuse("aircraft.motors", "is no list");
    for (const Json& motor : *motors) out.motors.push_back(motor_of(file, motor));
  }
  if (const Json* place = JsonFields::find(object, "place")) {
    out.place = core::AircraftSummary::Place{number_in(file, *place, "latitude_deg", -90.0, 90.0),
                                             number_in(file, *place, "longitude_deg", -180.0, 180.0),
                                             file.optional_number(*place, "above_home_m")};
  }
  if (const Json* wind = JsonFields::find(object, "wind")) {
    out.wind = core::AircraftSummary::Wind{number_in(file, *wind, "m_s", 0.0, 1e3),
                                           number_in(file, *wind, "from_deg", 0.0, 360.0)};
  }
  return out;
}

std::string aircraft_words(const core::AircraftSummary& aircraft) {
  std::vector<std::string> parts;
  if (aircraft.place) parts.push_back(place_words(*aircraft.place));
  if (const auto& wind = aircraft.wind)
    parts.push_back(fmt::format("wind {:.1f} m/s from {:.0f} degrees", wind->m_s, wind->from_deg));
  std::vector<std::string> motors;
  for (const core::MotorRate& motor : aircraft.motors)
    motors.push_back(fmt::format("{:.2f} ± {:.2f}", motor.hz, motor.spread_hz));
  if (!motors.empty()) parts.push_back(fmt::format("motors at {} Hz", fmt::join(motors, ", ")));
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace app

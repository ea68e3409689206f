#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/rotors/aircraft.h"
#include "firmware_app/report/json_fields.h"

namespace app {

// What the aircraft stated during a run, for modal.json and back, and in words for a reader.

[[nodiscard]] nlohmann::ordered_json aircraft_json(const core::AircraftSummary& aircraft);
// Missing keys are unknown values. Throws drivers::FileError "FILE: aircraft.KEY: ..." for a value that cannot be.
[[nodiscard]] core::AircraftSummary aircraft_of(const nlohmann::ordered_json& object, const JsonFields& file);

// "47.123456 N, 8.123456 E, 24.5 m above home; wind 4.2 m/s from 310 degrees; motors at 95.21 +- 0.04, 96.02 +- 0.05
// Hz". Empty: nothing is known.
[[nodiscard]] std::string aircraft_words(const core::AircraftSummary& aircraft);

}  // namespace app

#pragma once

#include <string>
#include <vector>

#include "tools/hovermodal/batch/inventory.h"

namespace tools {

// One flight and where its results go.
struct FlightOrder {
  Flight flight;
  std::vector<std::string> overrides;  // "section.key=value"
  std::string into;                    // folder of its results
};

// The process that works on one flight is this program with these arguments, without its name; they also travel between
// machines.
[[nodiscard]] std::vector<std::string> arguments_of(const FlightOrder& order);

// Files in the flight's folder: what the combination takes, and what the process printed.
inline constexpr const char* kSumsFile = "flight.sums";
inline constexpr const char* kModesFile = "modal.json";
inline constexpr const char* kLogFile = "log.txt";

}  // namespace tools

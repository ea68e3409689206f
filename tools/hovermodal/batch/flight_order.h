#pragma once

#include <string>
#include <vector>

#include "tools/hovermodal/batch/inventory.h"

namespace tools {

// One flight and the folder of its results.
struct FlightOrder {
  Flight flight;
  std::vector<std::string> overrides;  // "section.key=value"
  std::string into;                    // folder of its results
};

// Orders for all flights found, in their order; out: folder of the batch.
[[nodiscard]] std::vector<FlightOrder> orders_of(const Inventory& found, const std::vector<std::string>& overrides,
                                                 const std::string& out);

// Arguments, without the program's name, of the process of this program that analyses one flight; also sent between
// machines.
[[nodiscard]] std::vector<std::string> arguments_of(const FlightOrder& order);

// Files in the flight's folder: the input of the combination, and the output of the process.
inline constexpr const char* kSumsFile = "flight.sums";
inline constexpr const char* kModesFile = "modal.json";
inline constexpr const char* kLogFile = "log.txt";

}  // namespace tools

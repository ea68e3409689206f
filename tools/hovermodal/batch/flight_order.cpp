#include "tools/hovermodal/batch/flight_order.h"

#include <filesystem>

namespace tools {

std::vector<FlightOrder> orders_of(const Inventory& found, const std::vector<std::string>& overrides,
                                   const std::string& out) {
  std::vector<FlightOrder> orders;
  for (const Flight& flight : found.flights) {
    orders.push_back({flight, overrides, (std::filesystem::path(out) / "flights" / flight.name).string()});
  }
  return orders;
}

std::vector<std::string> arguments_of(const FlightOrder& order) {
  std::vector<std::string> arguments{
      "batch-flight", "--kind", to_string(order.flight.kind), "--path", order.flight.path, "--into", order.into};
  if (!order.flight.config.empty()) arguments.insert(arguments.end(), {"--config", order.flight.config});
  for (const std::string& one : order.overrides) arguments.insert(arguments.end(), {"--set", one});
  return arguments;
}

}  // namespace tools

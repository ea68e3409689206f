#include "tools/hovermodal/batch/flight_order.h"

namespace tools {

std::vector<std::string> arguments_of(const FlightOrder& order) {
  std::vector<std::string> arguments{
      "batch-flight", "--kind", to_string(order.flight.kind), "--path", order.flight.path, "--into", order.into};
  if (!order.flight.config.empty()) arguments.insert(arguments.end(), {"--config", order.flight.config});
  for (const std::string& one : order.overrides) arguments.insert(arguments.end(), {"--set", one});
  return arguments;
}

}  // namespace tools

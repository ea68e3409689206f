#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tools/hovermodal/batch/workers.h"

namespace tools {

// Assigns every flight, in order, to a worker with room, and waits for all. Progress goes to standard error, a failure
// as soon as it is known; with `is_quiet` nothing. Returns why each flight failed; "" = it succeeded.
[[nodiscard]] std::vector<std::string> work_on_all(const std::vector<FlightOrder>& orders,
                                                   const std::vector<std::unique_ptr<Workers>>& workers, bool is_quiet);

}  // namespace tools

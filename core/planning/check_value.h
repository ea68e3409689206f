#pragma once

#include <string>

namespace core::planning {

// Throws std::invalid_argument "plan: WHAT is VALUE; ADVICE", also for NaN.
void require(bool ok, const std::string& what, double value, const std::string& advice);
void require_range(const std::string& what, double value, double low, double high);

}  // namespace core::planning

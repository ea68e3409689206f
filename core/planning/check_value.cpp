#include "core/planning/check_value.h"

#include <cstdio>
#include <stdexcept>

namespace core::planning {
namespace {

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

}  // namespace

void require(bool ok, const std::string& what, double value, const std::string& advice) {
  if (!ok) throw std::invalid_argument("plan: " + what + " is " + short_number(value) + "; " + advice);
}

void require_range(const std::string& what, double value, double low, double high) {
  require(value >= low && value <= high, what, value,
          "give a value from " + short_number(low) + " to " + short_number(high));
}

}  // namespace core::planning

#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace core::structure {

template <class... Parts>
[[noreturn]] void refuse_declaration(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  throw std::invalid_argument(text.str());
}

inline void require_value(double value, double low, double high, const std::string& what) {
  if (!(value >= low && value <= high))
    refuse_declaration(what, ": ", value, " is refused: allowed ", low, " .. ", high);
}

}  // namespace core::structure

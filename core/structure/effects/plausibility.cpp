#include "core/structure/effects/plausibility.h"

#include <sstream>

namespace core::structure {

std::string outside(double value, double low, double high, std::string_view what) {
  if (value >= low && value <= high) return {};
  std::ostringstream text;
  text.precision(3);
  text << what << " of " << value << " is outside " << low << " .. " << high;
  return text.str();
}

std::optional<Obstacle> needs_storeys(const DeclaredFrame& declared, std::size_t n) {
  if (declared.model) return Obstacle{kOtherKind, "use the effects of that kind"};
  if (declared.n_storeys >= n) return std::nullopt;
  return Obstacle{"with so few storeys it is a common factor of all frequencies, which stiffness over mass absorbs",
                  "measure the stiffness or the masses"};
}

}  // namespace core::structure

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "core/structure/structural_effect.h"

namespace core::structure {

// "a mass of 1.93 is outside 0.2 .. 5"; empty if it lies inside.
[[nodiscard]] std::string outside(double value, double low, double high, std::string_view what);
// Obstacle of effects that change one storey relative to the others: there must be other storeys.
// Not for models of other kinds than a shear frame.
[[nodiscard]] std::optional<Obstacle> needs_storeys(const DeclaredFrame& declared, std::size_t n);

}  // namespace core::structure

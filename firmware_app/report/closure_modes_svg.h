#pragma once

#include <string>

#include "core/types/closure_result.h"

namespace app {

// The error of each mode's frequency before and after, in percent, with one standard deviation of the reference to
// both sides; a complete SVG file. Empty where no mode has a reference.
inline constexpr const char* kModelErrorAxis = "frequency of the model less the reference, %";
[[nodiscard]] std::string closure_modes_svg(const core::closure::ClosureResult& result,
                                            const std::string& axis = kModelErrorAxis);
// The same for a phone of 360 px, its legend below the panel.
[[nodiscard]] std::string closure_modes_narrow_svg(const core::closure::ClosureResult& result, const std::string& axis);

}  // namespace app

#pragma once

#include <string>

#include "core/types/closure_result.h"

namespace app {

// Text of closure.json: no wall clock, no paths; the same input gives the same bytes. Unknown is null.
[[nodiscard]] std::string closure_json(const core::closure::ClosureResult& result);

// The error of each mode's frequency before and after, in percent, with one standard deviation of the reference to
// both sides; a complete SVG file. Empty where no mode has a reference.
[[nodiscard]] std::string closure_modes_svg(const core::closure::ClosureResult& result,
                                            const std::string& axis = "frequency of the model less the reference, %");

}  // namespace app

#pragma once

#include <string>

#include "core/types/closure_result.h"

namespace app {

// closure_modes_svg() of closure_json.h for a phone of 360 px, its legend below the panel.
[[nodiscard]] std::string closure_modes_narrow_svg(const core::closure::ClosureResult& result, const std::string& axis);

}  // namespace app

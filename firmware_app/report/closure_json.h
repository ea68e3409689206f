#pragma once

#include <string>

#include "core/types/closure_result.h"

namespace app {

// Text of closure.json: no wall clock, no paths; the same input gives the same bytes. Unknown is null.
[[nodiscard]] std::string closure_json(const core::closure::ClosureResult& result);

}  // namespace app

#pragma once

#include <string>
#include <vector>

#include "core/closure/closure_result.h"

namespace tools {

// The result for a terminal: before -> effect -> after, rivals, what cannot be seen. `meanings`: of each step's numbers
// in other words, may be empty.
[[nodiscard]] std::string closure_text(const core::closure::ClosureResult& result,
                                       const std::vector<std::string>& meanings);

}  // namespace tools

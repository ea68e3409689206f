#pragma once

#include <string>

#include "core/types/closure_result.h"

namespace tools {

// The result for a terminal: before -> effect -> after, rivals, unobservable effects.
[[nodiscard]] std::string closure_text(const core::closure::ClosureResult& result);

}  // namespace tools

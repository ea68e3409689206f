#pragma once

#include <string>

#include "tools/hovermodal/closeloop/closeloop_series.h"

namespace tools {

// `closeloop --structure FILE --reference FILE`: the structure level; `check`: modes excluded from the fit, may be
// empty. The folder of the report exists. Throws drivers::FileError, std::runtime_error.
void close_structure(const LoopRequest& request, const std::string& structure, const std::string& check);

}  // namespace tools

#pragma once

#include "tools/validate/geometry.h"

namespace tools {

// What spectral lines of a machine beside a mode, and of the camera's rotors, are called, and what they do to the
// modes: the flights of trust.h. Prints tab-separated lines.
void print_lines_beside_modes(const GeometryOptions& options);

}  // namespace tools

// What is no mode: the camera's own vibration, and steady forces.
#include <fmt/format.h>

#include "tools/hovermodal/selftest/identification.h"

namespace tools {
void print_null(const IdentificationOptions&) {}
void print_harmonics(const IdentificationOptions&) {}
}  // namespace tools

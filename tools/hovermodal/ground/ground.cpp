#include <CLI/CLI.hpp>

#include "tools/hovermodal/commands.h"

namespace tools {

void add_ground(CLI::App&) {}

}  // namespace tools

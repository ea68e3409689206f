#include "tools/hovermodal/commands.h"

namespace tools {
void add_compare(CLI::App&) {}
}  // namespace tools

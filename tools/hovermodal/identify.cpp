#include "tools/hovermodal/commands.h"

namespace tools {
void add_identify(CLI::App&) {}
}  // namespace tools

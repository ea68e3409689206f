#include "tools/hovermodal/commands.h"

namespace tools {
void add_replay(CLI::App&) {}
}  // namespace tools

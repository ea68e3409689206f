#pragma once

#include <string>

#include "drivers/host/command_line.h"

namespace tools {

// A file that the user names for a result is replaced only with --force. Called before the work begins. Throws
// std::invalid_argument naming the file and --force if `path` exists; an empty path is none.
void require_free(const std::string& path, bool force);

void add_force_option(drivers::Command& command, bool& force);

}  // namespace tools

#pragma once

#include "drivers/host/command_line.h"

namespace tools {

// Adds `telemetry` to `inspect`; as in commands.h.
void add_inspect_telemetry(drivers::Command& inspect);

}  // namespace tools

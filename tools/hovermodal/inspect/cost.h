#pragma once

#include "drivers/host/command_line.h"

namespace tools {

void add_inspect_cost(drivers::Command& inspect);

}  // namespace tools

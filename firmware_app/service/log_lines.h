#pragma once

namespace app {

// From now on the log shows every message as printable text (drivers/storage/printable.h): names of files and devices
// in it cannot control a terminal, nor begin a line that looks like another message. Call before any thread logs.
void log_printable_lines();

}  // namespace app

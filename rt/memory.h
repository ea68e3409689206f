#pragma once

#include <string>

namespace rt {

// Locks all present and future pages of the process into memory, so that no page fault delays a stage. Returns an empty
// text, or why it was refused and how to allow it.
[[nodiscard]] std::string lock_memory();

}  // namespace rt

#pragma once

#include <cstdint>
#include <string>

namespace drivers {

// Memory that this process may still take, in bytes: the least of what the computer has available, the limits of the
// process (RLIMIT_AS, RLIMIT_DATA) and those of its control group. UINT64_MAX: unknown. For tests another root of
// /proc and /sys. Reads files: set-up time only.
[[nodiscard]] std::uint64_t memory_left(const std::string& root = "/");

}  // namespace drivers

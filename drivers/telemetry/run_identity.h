#pragma once

#include <cstdint>

namespace drivers {

// Identity of this process among all runs of all computers: of the boot (boot_id()), the computer's name, the process
// and the instant of the first call. Constant within a process, never 0. For messages only: no result contains it.
[[nodiscard]] std::uint64_t run_identity();

}  // namespace drivers

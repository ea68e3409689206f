#pragma once

namespace drivers {

// Memory set aside at the start of a program. When none is left, operator new takes it and goes on: what can fail
// nowhere (destructors, libraries that terminate) does not fail, and a run comes to its end with its report. Further
// shortages throw std::bad_alloc.
void keep_memory_reserve();                            // before any thread starts; throws std::bad_alloc
[[nodiscard]] bool memory_reserve_is_used() noexcept;  // any thread: memory has run out once
inline constexpr const char* kMemoryReserveUsed =
    "memory ran out, and the reserve of this process was taken: nothing was lost so far, but the next shortage "
    "ends the run; free memory, or lower spectrum.segment or the number of points";

}  // namespace drivers

#pragma once

#include <cstddef>

namespace rt {

// Data written by different threads is kept this far apart. 64 bytes on x86-64 and Cortex-A; a fixed number, because
// std::hardware_destructive_interference_size may differ between compilation units.
inline constexpr std::size_t kCacheLineBytes = 64;

}  // namespace rt

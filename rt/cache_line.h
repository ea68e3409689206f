#pragma once

#include <cstddef>

namespace rt {

// Data written by different threads is kept this far apart: two lines of 64 bytes, because x86-64 fetches lines in
// pairs (64 makes the ring two to four times slower at times: tests/bench/ring_speed.cpp) and some arm64 cores have
// lines of 128. A fixed number, because std::hardware_destructive_interference_size may differ between compilation
// units.
inline constexpr std::size_t kCacheLineBytes = 128;

}  // namespace rt

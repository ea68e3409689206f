#pragma once

#include <cstdint>

namespace drivers {

// Each event of an LCM event log begins with it, big endian.
inline constexpr std::uint32_t kEventSync = 0xEDA1DA01U;
// That, and its number, time and two lengths, before channel and data.
inline constexpr std::uint64_t kEventHeadBytes = 28;

}  // namespace drivers

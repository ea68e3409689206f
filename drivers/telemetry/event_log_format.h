#pragma once

#include <cstdint>

namespace drivers {

// Each event of an LCM event log begins with it, big endian.
inline constexpr std::uint32_t kEventSync = 0xEDA1DA01U;

}  // namespace drivers

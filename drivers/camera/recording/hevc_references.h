#pragma once

#include <cstdint>
#include <span>

namespace drivers {

// Pictures that an HEVC stream asks its decoder to keep, the one being decoded among them, from the sequence parameter
// sets in its extradata (hvcC or start codes; ITU-T H.265, 7.3.2.2.1). 0: none is found. Accepts any bytes.
[[nodiscard]] int hevc_references(std::span<const std::uint8_t> extradata) noexcept;

}  // namespace drivers

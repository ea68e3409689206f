#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "tests/device/uvc_descriptors.h"

namespace usb {

// Class requests: USB Video Class 1.1, table A-8.
enum ClassRequest { kSet = 0x01, kGet = 0x81, kLeast, kMost, kStep, kLength, kInfo, kDefault };

using Answer = std::optional<std::vector<std::uint8_t>>;  // none: the request stalls

// The camera terminal's exposure, in 0.1 ms, and its mode: automatic exposure varies until it is set to manual.
class ExposureControl {
 public:
  [[nodiscard]] Answer answer(int request, int selector, const std::vector<std::uint8_t>& from_host) {
    constexpr int kMode = 2, kExposure = 4;
    constexpr std::uint32_t kManual = 1, kAutomatic = 2;
    if (selector != kMode && selector != kExposure) return std::nullopt;
    const bool is_mode = selector == kMode;
    std::uint32_t& value = is_mode ? mode_ : exposure_;
    const auto bytes_of = [is_mode](std::uint32_t v) {
      Bytes bytes;
      bytes.add_32(v);
      std::vector<std::uint8_t> out = bytes.bytes();
      out.resize(is_mode ? 1 : 4);
      return out;
    };
    switch (request) {
      case kSet:
        value = 0;
        for (std::size_t i = std::min<std::size_t>(from_host.size(), 4); i-- > 0;) value = value << 8U | from_host[i];
        return std::vector<std::uint8_t>{};
      case kGet:
        if (!is_mode && mode_ != kManual) exposure_ = 50 + exposure_ % 100;
        return bytes_of(value);
      case kLeast:
        return bytes_of(1);
      case kMost:
        return bytes_of(10'000);
      case kStep:
        return bytes_of(is_mode ? kManual | kAutomatic : 1);
      case kDefault:
        return bytes_of(is_mode ? kAutomatic : 100);
      case kInfo:
        return std::vector<std::uint8_t>{3};
      default:
        return std::nullopt;
    }
  }

 private:
  std::uint32_t mode_ = 2, exposure_ = 77;
};

}  // namespace usb

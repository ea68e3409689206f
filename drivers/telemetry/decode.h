#pragma once

#include <cstddef>
#include <optional>
#include <utility>

namespace drivers {

// Far above any message of ours (a spectrum of 65536 points is 131 kB): bounds what a hostile datagram can allocate.
inline constexpr std::size_t kMaxMessageBytes = std::size_t{1} << 20;

// Bytes from the network into a generated type; empty when they are not exactly one such message. Always decodes into
// a fresh object: lcm-gen leaves an old array standing where the new one is empty.
template <class Message>
[[nodiscard]] std::optional<Message> decode_message(const void* data, std::size_t n_bytes) noexcept {
  if (n_bytes > kMaxMessageBytes) return std::nullopt;
  try {
    std::optional<Message> message(std::in_place);
    const int size = static_cast<int>(n_bytes);
    if (message->decode(data, 0, size) != size) return std::nullopt;
    return message;
  } catch (...) {
    return std::nullopt;
  }
}

}  // namespace drivers

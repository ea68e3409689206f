#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

namespace drivers {

// Far above any message of this project (a spectrum of 65536 points is 131 kB): bounds what a hostile datagram
// allocates.
inline constexpr std::size_t kMaxMessageBytes = std::size_t{1} << 20;

// The first eight bytes of a message, which identify its layout; empty if there are fewer bytes.
[[nodiscard]] inline std::optional<std::int64_t> fingerprint_of(const void* data, std::size_t n_bytes) noexcept {
  constexpr std::size_t kFingerprintBytes = 8;
  if (n_bytes < kFingerprintBytes) return std::nullopt;
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < kFingerprintBytes; ++i) value = value << 8U | bytes[i];
  return static_cast<std::int64_t>(value);
}

// Bytes from the network into a generated type; empty unless they are exactly one such message. Always decodes into
// a new object, because lcm-gen keeps an old array if the new one is empty.
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

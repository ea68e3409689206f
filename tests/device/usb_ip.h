#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

namespace usb {

inline void send_all(int socket, const void* data, std::size_t n) {
  const auto* bytes = static_cast<const char*>(data);
  while (n > 0) {
    const ssize_t sent = send(socket, bytes, n, MSG_NOSIGNAL);
    if (sent <= 0) throw std::runtime_error("the host controller hung up");
    bytes += sent;
    n -= static_cast<std::size_t>(sent);
  }
}

[[nodiscard]] inline bool receive_all(int socket, void* data, std::size_t n) {
  auto* bytes = static_cast<char*>(data);
  while (n > 0) {
    const ssize_t got = read(socket, bytes, n);
    if (got <= 0) return false;
    bytes += got;
    n -= static_cast<std::size_t>(got);
  }
  return true;
}

// The header of every USB/IP packet, in network byte order on the wire (Documentation/usb/usbip_protocol.rst).
struct Header {
  std::array<std::uint32_t, 10> words{};
  std::array<std::uint8_t, 8> setup{};

  [[nodiscard]] std::uint32_t word(std::size_t i) const { return ntohl(words[i]); }
  void set(std::size_t i, std::uint32_t value) { words[i] = htonl(value); }
};
static_assert(sizeof(Header) == 48);
enum Command : std::uint32_t { kSubmit = 1, kUnlink = 2, kSubmitted = 3, kUnlinked = 4 };

}  // namespace usb

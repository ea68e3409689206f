#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace tools {

struct ListeningSocket {
  int fd = -1;
  int port = 0;
};

// Neither waits nor is inherited. Throws std::system_error with a remedy.
[[nodiscard]] ListeningSocket listen_on(const std::string& address, int port);

// Who is at the other end, without the port; zeros where that cannot be told.
using PeerAddress = std::array<std::uint8_t, 16>;

// The next connection that waits, with its peer; -1: none does.
[[nodiscard]] int accept_next(int listener, PeerAddress& peer) noexcept;

}  // namespace tools

#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace tools {

struct ListeningSocket {
  int fd = -1;
  int port = 0;
};

// Non-blocking and not inherited by child processes. Throws std::system_error with a remedy.
[[nodiscard]] ListeningSocket listen_on(const std::string& address, int port);

// The peer's address, without the port; zeros if unknown.
using PeerAddress = std::array<std::uint8_t, 16>;

// The next waiting connection, with its peer; -1: none.
[[nodiscard]] int accept_next(int listener, PeerAddress& peer) noexcept;

}  // namespace tools

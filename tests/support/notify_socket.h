#pragma once

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string>

namespace tests {

// Replaces systemd: receives the messages of a process with this NOTIFY_SOCKET. Sets the variable while it exists.
class NotifySocket {
 public:
  NotifySocket() : name_("@hovermodal_notify_" + std::to_string(getpid())) {
    socket_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, name_.data(), name_.size());
    address.sun_path[0] = '\0';  // abstract: no file is left behind
    const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name_.size());
    (void)bind(socket_, reinterpret_cast<const sockaddr*>(&address), length);
    setenv("NOTIFY_SOCKET", name_.c_str(), 1);
  }
  ~NotifySocket() {
    unsetenv("NOTIFY_SOCKET");
    close(socket_);
  }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  [[nodiscard]] static bool is_heard() {
#ifdef HOVERMODAL_WITH_SYSTEMD
    return true;
#else
    return false;
#endif
  }

  // The next message; empty if there is none within the time.
  [[nodiscard]] std::string receive(int patience_ms = 0) const {
    std::array<char, 4096> text{};
    for (int waited_ms = 0;; waited_ms += 5) {
      const auto n = recv(socket_, text.data(), text.size(), MSG_DONTWAIT);
      if (n > 0) return {text.data(), static_cast<std::size_t>(n)};
      if (waited_ms >= patience_ms) return {};
      usleep(5000);
    }
  }

 private:
  std::string name_;
  int socket_ = -1;
};

}  // namespace tests

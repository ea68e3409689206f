#pragma once

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "tests/support/patience.h"

namespace tests {

// A TCP connection to 127.0.0.1 on which a test sends arbitrary bytes. Never raises SIGPIPE.
class RawConnection {
 public:
  // `source`: connects from 127.0.0.source.
  explicit RawConnection(int port, std::uint8_t source = 1)
      : fd_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)), error_(connect_to(port, source)) {}
  ~RawConnection() {
    if (fd_ >= 0) close(fd_);
  }
  RawConnection(RawConnection&& other) noexcept : fd_(other.fd_), error_(other.error_) { other.fd_ = -1; }
  RawConnection(const RawConnection&) = delete;
  RawConnection& operator=(const RawConnection&) = delete;
  RawConnection& operator=(RawConnection&&) = delete;

  bool send(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t n = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (n <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    return true;
  }
  void end() { shutdown(fd_, SHUT_WR); }  // nothing more will be sent
  // Reads until the other side closes, `enough` was received, or the time runs out.
  std::string receive(std::string_view enough = {}, int patience_ms = 10000) {
    std::string out;
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(patience_ms) * kSlowdown;
    while (std::chrono::steady_clock::now() < deadline) {
      pollfd waiting{fd_, POLLIN, 0};
      if (poll(&waiting, 1, 50) <= 0) continue;
      std::array<char, 65536> buffer{};
      const ssize_t n = recv(fd_, buffer.data(), buffer.size(), 0);
      if (n <= 0) break;
      out.append(buffer.data(), static_cast<std::size_t>(n));
      if (!enough.empty() && out.find(enough) != out.npos) break;
    }
    return out;
  }
  [[nodiscard]] bool is_open() const { return error_ == 0; }
  [[nodiscard]] int error() const { return error_; }  // errno of the failure

 private:
  int connect_to(int port, std::uint8_t source) {
    sockaddr_in from{}, to{};
    from.sin_family = AF_INET;
    from.sin_addr.s_addr = htonl((INADDR_LOOPBACK & ~0xFFU) | source);
    if (bind(fd_, reinterpret_cast<sockaddr*>(&from), sizeof from) != 0) return errno;
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (connect(fd_, reinterpret_cast<sockaddr*>(&to), sizeof to) == 0) return 0;
    return errno == EINTR ? connected_later() : errno;
  }
  // A signal (a fuzzer's timer) came during connect(); the kernel continues to connect.
  int connected_later() {
    pollfd waiting{fd_, POLLOUT, 0};
    while (poll(&waiting, 1, -1) < 0 && errno == EINTR) {
    }
    int error = 0;
    socklen_t size = sizeof error;
    return getsockopt(fd_, SOL_SOCKET, SO_ERROR, &error, &size) == 0 ? error : errno;
  }

  int fd_;
  int error_;
};

// The complete answer to one request sent literally.
inline std::string raw_http(int port, std::string_view request) {
  RawConnection connection(port);
  if (!connection.is_open() || !connection.send(request)) return {};
  return connection.receive();
}

inline std::string get(const std::string& target, const std::string& headers = "",
                       const std::string& host = "127.0.0.1") {
  return "GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\n" + headers + "\r\n";
}

// 200 for "HTTP/1.1 200 OK"; 0 if there is no status.
inline int status_of(std::string_view answer) {
  return answer.substr(0, 9) == "HTTP/1.1 " ? std::stoi(std::string(answer.substr(9, 3))) : 0;
}

}  // namespace tests

#include "tools/hovermodal/ground/web_socket.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

namespace tools {
namespace {

constexpr int kBacklog = 128;

int port_of(int fd) {
  sockaddr_storage bound{};
  socklen_t size = sizeof bound;
  if (getsockname(fd, reinterpret_cast<sockaddr*>(&bound), &size) != 0) return 0;
  return ntohs(bound.ss_family == AF_INET6 ? reinterpret_cast<sockaddr_in6*>(&bound)->sin6_port
                                           : reinterpret_cast<sockaddr_in*>(&bound)->sin_port);
}

}  // namespace

ListeningSocket listen_on(const std::string& address, int port) {
  addrinfo hints{}, *found = nullptr;
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV | AI_PASSIVE;
  hints.ai_socktype = SOCK_STREAM;
  const std::string what = fmt::format("web server on {} port {}", address, port);
  if (getaddrinfo(address.c_str(), std::to_string(port).c_str(), &hints, &found) != 0) {
    throw std::system_error(EINVAL, std::generic_category(), what);
  }
  const int fd = socket(found->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const int on = 1;
  if (fd >= 0) setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  const bool ok = fd >= 0 && bind(fd, found->ai_addr, found->ai_addrlen) == 0 && ::listen(fd, kBacklog) == 0;
  const int error = errno;
  freeaddrinfo(found);
  if (!ok) {
    if (fd >= 0) close(fd);
    const char* remedy = error == EADDRINUSE ? "; is another one running? Choose another --port" : "";
    throw std::system_error(error, std::generic_category(), what + remedy);
  }
  return {fd, port_of(fd)};
}

int accept_next(int listener, PeerAddress& peer) noexcept {
  sockaddr_storage from{};
  socklen_t size = sizeof from;
  const int fd = accept4(listener, reinterpret_cast<sockaddr*>(&from), &size, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (fd < 0) return -1;
  peer = {};
  if (from.ss_family == AF_INET)
    std::memcpy(peer.data(), &reinterpret_cast<sockaddr_in*>(&from)->sin_addr, sizeof(in_addr));
  // Of IPv6 only the network part: one host may use any number of addresses in it.
  if (from.ss_family == AF_INET6) std::memcpy(peer.data(), &reinterpret_cast<sockaddr_in6*>(&from)->sin6_addr, 8);
  const int on = 1;
  setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  return fd;
}

}  // namespace tools

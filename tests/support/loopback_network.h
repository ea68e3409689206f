#pragma once

#include <arpa/inet.h>
#include <net/if.h>
#include <net/route.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

namespace tests {

// Takes the loopback device of the calling thread's network up or down. Returns "" or what failed.
inline std::string set_loopback(bool is_up) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  ifreq request{};
  std::strncpy(request.ifr_name, "lo", IFNAMSIZ - 1);
  request.ifr_flags = is_up ? IFF_UP | IFF_MULTICAST : 0;
  const bool ok = ioctl(fd, SIOCSIFFLAGS, &request) == 0;
  const std::string error = ok ? "" : std::string("loopback up or down: ") + std::strerror(errno);
  close(fd);
  return error;
}

// As `ip route add 224.0.0.0/4 dev lo`.
inline std::string add_multicast_route() {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const auto set = [](sockaddr& where, const char* address) {
    sockaddr_in in{};
    in.sin_family = AF_INET;
    inet_pton(AF_INET, address, &in.sin_addr);
    std::memcpy(&where, &in, sizeof in);
  };
  rtentry route{};
  char device[] = "lo";
  set(route.rt_dst, "224.0.0.0");
  set(route.rt_genmask, "240.0.0.0");
  route.rt_dev = device;
  route.rt_flags = RTF_UP;
  const bool ok = ioctl(fd, SIOCADDRT, &route) == 0;
  const std::string error = ok ? "" : std::string("route 224.0.0.0/4 dev lo: ") + std::strerror(errno);
  close(fd);
  return error;
}

// Gives the calling thread, and every thread and process it starts later, its own network with a loopback
// device only: tests do not receive each other's messages or send to the real network, and need no route set up
// beforehand. Works as root, and for others where unprivileged user namespaces are allowed (then only while the process
// has one thread). Returns "" or why not.
inline std::string enter_private_network(bool with_multicast_route) {
  if (unshare(CLONE_NEWNET) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) {
    return std::string("unshare: ") + std::strerror(errno);
  }
  const std::string error = set_loopback(true);
  return error.empty() && with_multicast_route ? add_multicast_route() : error;
}

// Once per process.
inline const std::string& private_loopback() {
  static const std::string error = enter_private_network(true);
  return error;
}

}  // namespace tests

// At the top of a test that talks over LCM's udpm.
#define SKIP_WITHOUT_PRIVATE_LOOPBACK()                                                                  \
  if (const std::string why = tests::private_loopback(); !why.empty()) {                                 \
    GTEST_SKIP() << "needs a private loopback network (root, or unprivileged user namespaces): " << why; \
  }

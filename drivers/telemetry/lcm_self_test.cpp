#include "drivers/telemetry/lcm_self_test.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <random>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "drivers/telemetry/lcm_url.h"

namespace drivers {
namespace {

constexpr auto kPatience = std::chrono::milliseconds(500);
constexpr int kResend_ms = 50;
constexpr const char* kHowToMend =
    "For use on this computer alone (ttl=0): `ip link set lo multicast on` and `ip route add 224.0.0.0/4 dev lo` "
    "(as root). To reach a ground station: ttl=1 in the URL and `ip route add 224.0.0.0/4 dev <its interface>`. "
    "To run without telemetry leave telemetry.lcm_url empty.";

class Socket {
 public:
  Socket() : fd_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {}
  ~Socket() {
    if (fd_ >= 0) close(fd_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  [[nodiscard]] int fd() const noexcept { return fd_; }
  template <class Value>
  bool set(int level, int name, const Value& value) {
    return setsockopt(fd_, level, name, &value, sizeof value) == 0;
  }

 private:
  int fd_;
};

sockaddr_in address_of(const UdpmUrl& url) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(url.port);
  inet_pton(AF_INET, url.group.c_str(), &address.sin_addr);
  return address;
}

const sockaddr* generic(const sockaddr_in& address) {
  const void* p = &address;  // the sockets interface uses this cast for its address types
  return static_cast<const sockaddr*>(p);
}

// A small LCM message: magic "LC02", message number, channel with its zero, payload. Other receivers of the group see
// a well-formed message on a separate channel.
std::vector<char> probe_message(const std::string& channel_prefix) {
  std::vector<char> bytes{'L', 'C', '0', '2', 0, 0, 0, 0};
  const std::string channel = channel_prefix + "_SELFTEST";
  bytes.insert(bytes.end(), channel.begin(), channel.end());
  bytes.push_back('\0');
  std::random_device random;
  for (int i = 0; i < 16; ++i) bytes.push_back(static_cast<char>(random() & 0xFFU));
  return bytes;
}

// "" or why no receiving socket is possible. Bound to the group, not to any address: as with LCM, several may share the
// port.
std::string open_ear(const UdpmUrl& url, Socket& ear) {
  const int on = 1;
  sockaddr_in address = address_of(url);
  ip_mreq membership{};
  membership.imr_multiaddr = address.sin_addr;
  membership.imr_interface.s_addr = htonl(INADDR_ANY);
  if (ear.fd() < 0) return fmt::format("no socket: {}", std::strerror(errno));
  if (!ear.set(SOL_SOCKET, SO_REUSEADDR, on) || !ear.set(SOL_SOCKET, SO_REUSEPORT, on) ||
      bind(ear.fd(), generic(address), sizeof address) != 0) {
    return fmt::format("cannot listen on {}:{}: {}", url.group, url.port, std::strerror(errno));
  }
  if (!ear.set(IPPROTO_IP, IP_ADD_MEMBERSHIP, membership)) {
    return fmt::format("cannot join the multicast group {}: {}", url.group, std::strerror(errno));
  }
  return {};
}

std::string send_probe(const UdpmUrl& url, Socket& mouth, const std::vector<char>& probe) {
  const sockaddr_in address = address_of(url);
  const auto sent = sendto(mouth.fd(), probe.data(), probe.size(), 0, generic(address), sizeof address);
  if (sent == static_cast<ssize_t>(probe.size())) return {};
  const int error = errno;
  return fmt::format("cannot send to {}:{}: {}{}", url.group, url.port, std::strerror(error),
                     error == ENETUNREACH ? " (there is no route for multicast)" : "");
}

bool hears(Socket& ear, const std::vector<char>& probe, int timeout_ms) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(timeout_ms);
  std::array<char, 2048> buffer{};
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0) return false;
    pollfd poll_fd{ear.fd(), POLLIN, 0};
    if (poll(&poll_fd, 1, static_cast<int>(left.count())) <= 0) continue;
    const auto n = recv(ear.fd(), buffer.data(), buffer.size(), MSG_DONTWAIT);
    if (n == static_cast<ssize_t>(probe.size()) && std::memcmp(buffer.data(), probe.data(), probe.size()) == 0) {
      return true;
    }
  }
}

SelfTest test_udpm(const UdpmUrl& url, const std::string& channel_prefix) {
  Socket ear;
  Socket mouth;
  const std::vector<char> probe = probe_message(channel_prefix);
  const auto ttl = static_cast<unsigned char>(url.ttl);
  const unsigned char loop = 1;
  SelfTest out;
  const std::string deaf = open_ear(url, ear);
  if (!mouth.set(IPPROTO_IP, IP_MULTICAST_TTL, ttl) || !mouth.set(IPPROTO_IP, IP_MULTICAST_LOOP, loop)) {
    out.message = fmt::format("no multicast socket: {}", std::strerror(errno));
    return out;
  }
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  do {
    out.message = send_probe(url, mouth, probe);
    if (!out.message.empty()) return out;
    out.can_send = true;
    if (!deaf.empty()) break;
    out.heard = hears(ear, probe, kResend_ms);
  } while (!out.heard && std::chrono::steady_clock::now() < deadline);
  if (!out.heard) {
    out.message = !deaf.empty() ? deaf
                                : fmt::format(
                                      "a message sent to {}:{} did not come back within {} ms (a firewall, or "
                                      "a route through an interface without multicast)",
                                      url.group, url.port, kPatience.count());
  }
  return out;
}

}  // namespace

SelfTest run_lcm_self_test(const std::string& url, const std::string& channel_prefix) {
  check_lcm_url(url);
  if (!is_udpm(url)) return {true, true, {}};
  SelfTest out = test_udpm(parse_udpm(url), channel_prefix);
  if (!out.message.empty()) {
    out.message = fmt::format("telemetry self-test of LCM URL \"{}\": {}. {}", url, out.message, kHowToMend);
  }
  return out;
}

std::string lcm_self_test(const std::string& url) {
  try {
    return run_lcm_self_test(url, "HOVERMODAL").message;
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
}

}  // namespace drivers

#include "drivers/telemetry/lcm_diagnosis.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>

#include "drivers/telemetry/lcm_self_test.h"
#include "drivers/telemetry/lcm_url.h"

namespace drivers {
namespace {

using Findings = std::vector<LcmFinding>;

// Buffer recommended for a ground station (spectra and tracks of many points come in bursts).
constexpr long kWantedBuffer_bytes = 4194304;
constexpr long kLeastBuffer_bytes = 1048576;

struct Interface {
  std::string name;
  unsigned flags = 0;
  in_addr_t address = 0;  // 0: none
};

std::vector<Interface> interfaces() {
  std::vector<Interface> out;
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return out;
  for (const ifaddrs* i = all; i != nullptr; i = i->ifa_next) {
    Interface one{i->ifa_name, i->ifa_flags, 0};
    if (i->ifa_addr != nullptr && i->ifa_addr->sa_family == AF_INET) {
      sockaddr_in address{};
      std::memcpy(&address, i->ifa_addr, sizeof address);
      one.address = address.sin_addr.s_addr;
    } else if (i->ifa_addr != nullptr && i->ifa_addr->sa_family == AF_INET6) {
      continue;
    }
    out.push_back(one);
  }
  freeifaddrs(all);
  return out;
}

// Interfaces other than lo that can be used for multicast, for advice.
std::string usable_names() {
  std::string names;
  for (const Interface& i : interfaces()) {
    const bool is_usable = (i.flags & IFF_UP) != 0 && (i.flags & IFF_LOOPBACK) == 0;
    if (is_usable && i.address != 0) names += (names.empty() ? "" : ", ") + i.name;
  }
  return names.empty() ? "none is up and has an address" : names;
}

// The address from which the kernel would send to the group: shows the route. Nothing is sent.
std::optional<in_addr_t> source_address(const UdpmUrl& url, int& error) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in group{};
  group.sin_family = AF_INET;
  group.sin_port = htons(url.port);
  inet_pton(AF_INET, url.group.c_str(), &group.sin_addr);
  sockaddr_in own{};
  socklen_t size = sizeof own;
  void* to = &group;
  void* from = &own;
  const bool ok = connect(fd, static_cast<const sockaddr*>(to), sizeof group) == 0 &&
                  getsockname(fd, static_cast<sockaddr*>(from), &size) == 0;
  error = errno;
  if (fd >= 0) close(fd);
  return ok ? std::optional(own.sin_addr.s_addr) : std::nullopt;
}

LcmFinding check_loopback() {
  for (const Interface& i : interfaces()) {
    if ((i.flags & IFF_LOOPBACK) == 0) continue;
    if ((i.flags & IFF_UP) == 0) return {FindingKind::kBad, i.name + " is down", "ip link set " + i.name + " up"};
    return {FindingKind::kOk, i.name + " is up", ""};
  }
  return {FindingKind::kBad, "there is no loopback interface", ""};
}

// State of the interface on the route; `kBad` if messages would not leave through it.
LcmFinding check_interface(const Interface& i, const UdpmUrl& url) {
  const bool is_loopback = (i.flags & IFF_LOOPBACK) != 0;
  const std::string way = fmt::format("messages to {} go through {}", url.group, i.name);
  if ((i.flags & IFF_UP) == 0) return {FindingKind::kBad, way + ", which is down", "ip link set " + i.name + " up"};
  if (!is_loopback && (i.flags & IFF_MULTICAST) == 0)
    return {FindingKind::kBad, way + ", which does no multicast", fmt::format("ip link set {} multicast on", i.name)};
  if (!is_loopback && (i.flags & IFF_RUNNING) == 0)
    return {FindingKind::kBad, way + ", which has no link", "is the cable in, the radio on and connected?"};
  if (is_loopback && url.ttl > 0)
    return {
        FindingKind::kBad, fmt::format("{}: with ttl={} other computers are meant to hear, and cannot", way, url.ttl),
        fmt::format("ip route del 224.0.0.0/4 dev lo; ip route add 224.0.0.0/4 dev INTERFACE ({})", usable_names())};
  return {FindingKind::kOk, way, ""};
}

LcmFinding check_route(const UdpmUrl& url) {
  int error = 0;
  const auto source = source_address(url, error);
  if (!source) {
    const std::string dev = url.ttl == 0 ? "lo" : fmt::format("INTERFACE ({})", usable_names());
    return {FindingKind::kBad, fmt::format("there is no way to {}: {}", url.group, std::strerror(error)),
            "ip route add 224.0.0.0/4 dev " + dev};
  }
  for (const Interface& i : interfaces()) {
    if (i.address == *source) return check_interface(i, url);
  }
  return {FindingKind::kNote, fmt::format("messages to {} go through an interface without an address", url.group), ""};
}

LcmFinding check_reach(const UdpmUrl& url) {
  if (url.ttl == 0) {
    return {FindingKind::kNote, "ttl=0: messages stay on this computer",
            "to reach another: ttl=1 in the URL on both sides"};
  }
  return {FindingKind::kOk,
          fmt::format("ttl={}: messages reach {}", url.ttl,
                      url.ttl == 1 ? "the local network" : "beyond the local network"),
          ""};
}

LcmFinding check_round_trip(const std::string& url, const std::string& prefix) {
  const SelfTest test = run_lcm_self_test(url, prefix);
  if (test.heard) return {FindingKind::kOk, "a message sent was heard again on this computer", ""};
  const UdpmUrl parts = parse_udpm(url);
  return {FindingKind::kBad, test.message,
          test.can_send
              ? fmt::format("let UDP to {} port {} in and out (nft list ruleset, iptables -L -n); a group that "
                            "a switch blocks: another group in the URL",
                            parts.group, parts.port)
              : "see above"};
}

LcmFinding check_buffer(const UdpmUrl& url) {
  std::ifstream file("/proc/sys/net/core/rmem_max");
  long most = 0;
  if (!(file >> most)) return {FindingKind::kNote, "the largest receive buffer is not known", ""};
  const bool is_enough = most >= kLeastBuffer_bytes;
  return {is_enough ? FindingKind::kOk : FindingKind::kNote,
          fmt::format("receive buffers hold up to {} bytes{}", most,
                      is_enough ? "" : ": a burst of spectra or tracks may be lost"),
          is_enough ? (url.has_recv_buf_size ? "" : "programs of your own: recv_buf_size=4194304 in the URL")
                    : fmt::format("sysctl -w net.core.rmem_max={}, and recv_buf_size={} in the URL",
                                  kWantedBuffer_bytes, kWantedBuffer_bytes)};
}

}  // namespace

Findings diagnose_lcm(const std::string& url, const std::string& channel_prefix) {
  check_lcm_url(url);
  check_channel_prefix(channel_prefix);
  if (!is_udpm(url)) return {{FindingKind::kNote, fmt::format("\"{}\" is no network: nothing to test", url), ""}};
  const UdpmUrl parts = parse_udpm(url);
  return {check_loopback(), check_route(parts), check_reach(parts), check_round_trip(url, channel_prefix),
          check_buffer(parts)};
}

}  // namespace drivers

#pragma once

#include <cstdint>
#include <string>

namespace drivers {

inline constexpr const char* kDefaultLcmUrl = "udpm://239.255.76.67:7667?ttl=0";

// The parts of udpm://GROUP:PORT?ttl=N&recv_buf_size=N.
struct UdpmUrl {
  std::string group;  // dotted multicast address
  std::uint16_t port = 0;
  int ttl = 0;  // 0 = stays on this computer, 1 = reaches the local network
  bool has_recv_buf_size = false;
};

[[nodiscard]] bool is_udpm(const std::string& url);

// Stricter than LCM, which only prints a warning for what it does not understand.
// Throws std::invalid_argument naming the URL, its fault and the correct form.
[[nodiscard]] UdpmUrl parse_udpm(const std::string& url);

// Throws std::invalid_argument unless the URL has a provider that LCM knows (udpm, file, memq, tcpq) and, for udpm, is
// correct in every part.
void check_lcm_url(const std::string& url);

// Throws std::invalid_argument unless `prefix` can begin an LCM channel name (63 bytes at most) and a regular
// expression without surprises: letters, digits, _ - . /
void check_channel_prefix(const std::string& prefix);

// LCM subscribes by a regular expression: the expression that matches exactly this name, or part of a name.
[[nodiscard]] std::string exact_pattern(const std::string& name);

}  // namespace drivers

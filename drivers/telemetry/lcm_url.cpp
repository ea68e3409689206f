#include "drivers/telemetry/lcm_url.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace drivers {
namespace {

constexpr std::string_view kUdpmScheme = "udpm://";
constexpr std::size_t kMaxPrefixBytes = 48;

[[noreturn]] void refuse(const std::string& url, const std::string& what) {
  throw std::invalid_argument(
      fmt::format("LCM URL \"{}\": {}. Expected udpm://GROUP:PORT?ttl=N, for example {}", url, what, kDefaultLcmUrl));
}

std::optional<int> integer(std::string_view text, int low, int high) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value < low || value > high) return std::nullopt;
  return value;
}

void set_option(const std::string& url, std::string_view option, UdpmUrl& out) {
  const auto equals = option.find('=');
  const std::string_view key = option.substr(0, equals);
  const std::string_view value = equals == option.npos ? std::string_view{} : option.substr(equals + 1);
  if (key == "ttl") {
    const auto ttl = integer(value, 0, 255);
    if (!ttl) refuse(url, fmt::format("ttl \"{}\" is not a number from 0 to 255", value));
    out.ttl = *ttl;
  } else if (key == "recv_buf_size") {
    if (!integer(value, 1, std::numeric_limits<int>::max())) {
      refuse(url, fmt::format("recv_buf_size \"{}\" is not a positive number of bytes", value));
    }
    out.has_recv_buf_size = true;
  } else {
    refuse(url, fmt::format("unknown option \"{}\" (known: ttl, recv_buf_size)", key));
  }
}

void set_address(const std::string& url, std::string_view address, UdpmUrl& out) {
  const auto colon = address.find(':');
  if (colon == address.npos) refuse(url, "the port is missing");
  out.group = std::string(address.substr(0, colon));
  in_addr parsed{};
  if (inet_pton(AF_INET, out.group.c_str(), &parsed) != 1 || !IN_MULTICAST(ntohl(parsed.s_addr))) {
    refuse(url, fmt::format("\"{}\" is not a multicast address (224.0.0.0 to 239.255.255.255)", out.group));
  }
  const auto port = integer(address.substr(colon + 1), 1, 65535);
  if (!port) refuse(url, fmt::format("\"{}\" is not a port from 1 to 65535", address.substr(colon + 1)));
  out.port = static_cast<std::uint16_t>(*port);
}

}  // namespace

bool is_udpm(const std::string& url) { return std::string_view(url).substr(0, kUdpmScheme.size()) == kUdpmScheme; }

UdpmUrl parse_udpm(const std::string& url) {
  if (!is_udpm(url)) refuse(url, "does not begin with udpm://");
  UdpmUrl out;
  const std::string_view rest = std::string_view(url).substr(kUdpmScheme.size());
  const auto question = rest.find('?');
  set_address(url, rest.substr(0, question), out);
  std::string_view options = question == rest.npos ? std::string_view{} : rest.substr(question + 1);
  while (!options.empty()) {
    const auto end = options.find('&');
    set_option(url, options.substr(0, end), out);
    options = end == options.npos ? std::string_view{} : options.substr(end + 1);
  }
  return out;
}

void check_lcm_url(const std::string& url) {
  if (is_udpm(url)) {
    static_cast<void>(parse_udpm(url));
    return;
  }
  for (const std::string_view scheme : {"file://", "memq://", "tcpq://"}) {
    if (std::string_view(url).substr(0, scheme.size()) == scheme) return;
  }
  refuse(url, "LCM has no such provider (known: udpm, file, memq, tcpq)");
}

void check_channel_prefix(const std::string& prefix) {
  const bool is_plain = std::all_of(prefix.begin(), prefix.end(), [](unsigned char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == '.' || c == '/';
  });
  if (prefix.empty() || prefix.size() > kMaxPrefixBytes || !is_plain) {
    throw std::invalid_argument(fmt::format("LCM channel prefix \"{}\": expected 1 to {} letters, digits, or _ - . /",
                                            prefix, kMaxPrefixBytes));
  }
}

std::string exact_pattern(const std::string& name) {
  std::string pattern;
  for (const char c : name) pattern += c == '.' ? std::string("\\.") : std::string(1, c);
  return pattern;
}

}  // namespace drivers

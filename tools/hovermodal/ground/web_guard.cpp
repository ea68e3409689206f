#include "tools/hovermodal/ground/web_guard.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <system_error>

#include "drivers/storage/ascii.h"

namespace tools {
namespace {

constexpr std::size_t kLeastToken = 16, kLongestToken = 128, kLongestHost = 255;

bool is_token_character(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '_';
}

bool is_address(const std::string& text) {
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  return inet_pton(AF_INET, text.c_str(), bytes.data()) == 1 || inet_pton(AF_INET6, text.c_str(), bytes.data()) == 1;
}

bool is_known(const WebGuard& guard, const std::string& name) {
  if (name == "localhost" || is_loopback(name)) return true;
  if (!guard.loopback_only && is_address(name)) return true;
  return std::any_of(guard.known_names.begin(), guard.known_names.end(),
                     [&](const std::string& known) { return drivers::lower_ascii(known) == name; });
}

// The value of one cookie in "a=1; b=2"; the first if it occurs twice.
std::string_view cookie(std::string_view cookies, std::string_view name) {
  while (!cookies.empty()) {
    const std::size_t end = cookies.find(';');
    std::string_view one = cookies.substr(0, end);
    while (!one.empty() && one.front() == ' ') one.remove_prefix(1);
    if (one.size() > name.size() && one.substr(0, name.size()) == name && one[name.size()] == '=') {
      return one.substr(name.size() + 1);
    }
    if (end == std::string_view::npos) break;
    cookies.remove_prefix(end + 1);
  }
  return {};
}

}  // namespace

bool is_loopback(std::string_view address) {
  in_addr v4{};
  if (inet_pton(AF_INET, std::string(address).c_str(), &v4) == 1) return (ntohl(v4.s_addr) >> 24) == 127;
  in6_addr v6{};
  return inet_pton(AF_INET6, std::string(address).c_str(), &v6) == 1 && IN6_IS_ADDR_LOOPBACK(&v6);
}

std::optional<std::string> host_name(std::string_view host) {
  if (host.empty() || host.size() > kLongestHost) return std::nullopt;
  std::string_view name, port;
  if (host.front() == '[') {
    const std::size_t end = host.find(']');
    if (end == std::string_view::npos) return std::nullopt;
    name = host.substr(1, end - 1), port = host.substr(end + 1);
  } else {
    name = host.substr(0, host.find(':')), port = host.substr(name.size());
  }
  const bool is_port =
      port.empty() || (port.size() >= 2 && port.size() <= 6 && port[0] == ':' &&
                       std::all_of(port.begin() + 1, port.end(), [](char c) { return c >= '0' && c <= '9'; }));
  if (name.empty() || !is_port) return std::nullopt;
  return drivers::lower_ascii(name);
}

std::string refused_origin(const WebGuard& guard, const WebOrigin& request) {
  const auto name = host_name(request.host);
  if (!name) return "the request names no host";
  if (!is_known(guard, *name)) {
    return "the request is for a host of another name; open the page by its address, or start it with --name";
  }
  if (!request.origin.empty() &&
      drivers::lower_ascii(request.origin) != "http://" + drivers::lower_ascii(request.host)) {
    return "the request comes from a page of another origin";
  }
  const std::string_view site = request.fetch_site;
  // Following a link also counts as "cross-site", but opens the page as a whole, in its own origin.
  const bool is_link = request.fetch_mode == "navigate" && request.fetch_dest == "document";
  if (!site.empty() && site != "same-origin" && site != "none" && !is_link) {
    return "the request comes from a page of another site";
  }
  return {};
}

bool equal_in_constant_time(std::string_view a, std::string_view b) noexcept {
  unsigned different = a.size() == b.size() ? 0U : 1U;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const char other = b.empty() ? '\0' : b[i % b.size()];
    different |= static_cast<unsigned char>(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(other));
  }
  return different == 0;
}

TokenCheck check_token(const WebGuard& guard, std::string_view query, std::string_view cookies) {
  if (guard.token.empty()) return TokenCheck::kNotAsked;
  if (!query.empty()) return equal_in_constant_time(query, guard.token) ? TokenCheck::kFromQuery : TokenCheck::kWrong;
  const std::string_view kept = cookie(cookies, kTokenCookie);
  if (kept.empty()) return TokenCheck::kMissing;
  return equal_in_constant_time(kept, guard.token) ? TokenCheck::kFromCookie : TokenCheck::kWrong;
}

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  const auto wanted = static_cast<ssize_t>(bytes.size());  // getrandom() delivers up to 256 bytes at once
  if (getrandom(bytes.data(), bytes.size(), 0) != wanted) {
    throw std::system_error(errno, std::generic_category(), "no random numbers for an access token");
  }
  std::string out;
  for (const unsigned char byte : bytes) out += fmt::format("{:02x}", byte);
  return out;
}

std::string refused_token(std::string_view token) {
  if (token.size() < kLeastToken || token.size() > kLongestToken) {
    return fmt::format("{} characters: {} to {} are needed", token.size(), kLeastToken, kLongestToken);
  }
  if (!std::all_of(token.begin(), token.end(), is_token_character)) return "only letters, digits, - and _ are possible";
  return {};
}

}  // namespace tools

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tools {

// Access control. Pure: decides from a request's headers alone, so that tests need no socket.
//
// Two attacks use a browser that can reach the server while its user visits another site. A page of that site may send
// requests across origins: the browser then states this in Origin or Sec-Fetch-Site. Or its name may be resolved to
// this server (DNS rebinding), so that the browser assumes the same origin: then Host carries that name. A numeric
// address cannot be rebound.
struct WebGuard {
  std::string token;                     // empty: none required
  std::vector<std::string> known_names;  // names that Host may carry besides addresses and "localhost"
  bool loopback_only = true;             // true: the only addresses accepted are those of the loopback
};

// Headers of a request that the guard reads; empty: the request has no such header.
struct WebOrigin {
  std::string_view host, origin, fetch_site, fetch_mode, fetch_dest;
};

// Why the request is refused (403); empty: it is not.
[[nodiscard]] std::string refused_origin(const WebGuard& guard, const WebOrigin& request);

enum class TokenCheck { kNotAsked, kFromCookie, kFromQuery, kWrong, kMissing };
// `query` is the value of ?token=, empty where there is none; `cookies` the whole Cookie header.
[[nodiscard]] TokenCheck check_token(const WebGuard& guard, std::string_view query, std::string_view cookies);

// Takes the same time wherever the first difference is.
[[nodiscard]] bool equal_in_constant_time(std::string_view a, std::string_view b) noexcept;

// 128 bits of the kernel's random numbers as 32 hexadecimal digits. Throws std::system_error.
[[nodiscard]] std::string random_token();

// Why the text is not allowed as a token; empty: it is.
[[nodiscard]] std::string refused_token(std::string_view token);

[[nodiscard]] bool is_loopback(std::string_view address);
// "name:port", "[::1]:port", "name"; empty if it is none of these.
[[nodiscard]] std::optional<std::string> host_name(std::string_view host_header);

inline constexpr const char* kTokenCookie = "hovermodal_token";

}  // namespace tools

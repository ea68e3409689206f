#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tools {

// Who may ask. Pure: judged from a request's headers alone, so that a test needs no socket.
//
// Two attacks come through a browser that can reach the server while its owner visits another site. A page of that site
// may ask across origins: the browser then says so in Origin or Sec-Fetch-Site. Or its name may be made to point at us
// (DNS rebinding), and the browser believes it is the same origin: then Host carries that name. An address in figures
// cannot be rebound.
struct WebGuard {
  std::string token;                     // empty: none is asked for
  std::vector<std::string> known_names;  // that Host may carry beside addresses and "localhost"
  bool loopback_only = true;             // of the addresses only the loopback's own are known
};

// What of a request the guard looks at; empty: the request has no such header.
struct WebOrigin {
  std::string_view host, origin, fetch_site, fetch_mode, fetch_dest;
};

// Why the request is refused (403); empty: it is not.
[[nodiscard]] std::string refused_origin(const WebGuard& guard, const WebOrigin& request);

enum class TokenCheck { kNotAsked, kFromCookie, kFromQuery, kWrong, kMissing };
// `query` is the value of ?token=, empty where there is none; `cookies` the whole Cookie header.
[[nodiscard]] TokenCheck check_token(const WebGuard& guard, std::string_view query, std::string_view cookies);

// As long for a wrong first character as for a wrong last one.
[[nodiscard]] bool equal_in_constant_time(std::string_view a, std::string_view b) noexcept;

// 128 bits of the kernel's random numbers as 32 hexadecimal digits. Throws std::system_error.
[[nodiscard]] std::string random_token();

// Why the text cannot be a token; empty: it can.
[[nodiscard]] std::string refused_token(std::string_view token);

[[nodiscard]] bool is_loopback(std::string_view address);
// "name:port", "[::1]:port", "name"; empty where it is none of these.
[[nodiscard]] std::optional<std::string> host_name(std::string_view host_header);

inline constexpr const char* kTokenCookie = "hovermodal_token";

}  // namespace tools

#include "tools/hovermodal/ground/web_routes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <charconv>
#include <optional>
#include <stdexcept>
#include <utility>

namespace tools {
namespace {

namespace http = boost::beast::http;
using Request = http::request<http::string_body>;

// Allows only the page's own files, and forbids framing by other pages.
constexpr std::array<std::pair<const char*, const char*>, 6> kSafetyHeaders{{
    {"Content-Security-Policy",
     "default-src 'self'; object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"X-Frame-Options", "DENY"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cache-Control", "no-store"},
}};

constexpr const char* kText = "text/plain; charset=utf-8";

using Headers = std::vector<std::pair<std::string, std::string>>;

std::string_view view_of(boost::beast::string_view text) { return {text.data(), text.size()}; }

std::string head_of(int status, std::string_view content_type, const Headers& further) {
  std::string out =
      fmt::format("HTTP/1.1 {} {}\r\nConnection: close\r\nContent-Type: {}\r\n", status,
                  view_of(http::obsolete_reason(http::int_to_status(static_cast<unsigned>(status)))), content_type);
  for (const auto& [name, value] : kSafetyHeaders) out += fmt::format("{}: {}\r\n", name, value);
  for (const auto& [name, value] : further) out += fmt::format("{}: {}\r\n", name, value);
  return out;
}

WebResponse said(int status, const std::string& text) { return {status, kText, text + "\n"}; }

std::optional<Request> parsed(std::string_view bytes) {
  http::request_parser<http::string_body> parser;
  parser.eager(true);
  parser.header_limit(static_cast<std::uint32_t>(std::min<std::size_t>(bytes.size(), UINT32_MAX)));
  parser.body_limit(bytes.size());
  boost::beast::error_code error;
  parser.put(boost::asio::buffer(bytes.data(), bytes.size()), error);
  if (error || !parser.is_done()) return std::nullopt;
  return parser.release();
}

// %XX as its byte; what is no such triple stays as it is.
std::string decoded(std::string_view text, bool plus_is_space) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned byte = 0;
    const char* from = text.data() + i + 1;
    if (text[i] == '%' && i + 2 < text.size() && std::from_chars(from, from + 2, byte, 16).ptr == from + 2) {
      out += static_cast<char>(byte), i += 2;
    } else {
      out += text[i] == '+' && plus_is_space ? ' ' : text[i];
    }
  }
  return out;
}

// Value of the first parameter of that name in a query, decoded.
std::string parameter(std::string_view query, std::string_view name) {
  while (!query.empty()) {
    const std::size_t end = std::min(query.find('&'), query.size());
    const std::string_view part = query.substr(0, end);
    const std::size_t equals = std::min(part.find('='), part.size());
    if (decoded(part.substr(0, equals), true) == name)
      return decoded(part.substr(std::min(equals + 1, part.size())), true);
    query.remove_prefix(std::min(end + 1, query.size()));
  }
  return {};
}

}  // namespace

// Boost.Beast parses requests; answers are formatted here. No socket, file or route of a library takes part.
struct WebRoutes::Site {
  struct Outcome {
    WebResponse response;
    Headers headers;
    std::string_view asset;  // in place of response.body; of static length
    const Route* route = nullptr;
  };

  // The refusal of a request that may not be answered; empty where it may.
  [[nodiscard]] std::optional<WebResponse> refusal_of(const Request& request, std::string_view query,
                                                      Headers& headers) const {
    if (request.count(http::field::host) > 1) return said(400, "Host is said twice");
    const auto value = [&](boost::beast::string_view name) { return std::string(view_of(request[name])); };
    const std::string why = refused_origin(guard, {value("Host"), value("Origin"), value("Sec-Fetch-Site"),
                                                   value("Sec-Fetch-Mode"), value("Sec-Fetch-Dest")});
    if (!why.empty()) return said(403, why);
    switch (check_token(guard, parameter(query, "token"), value("Cookie"))) {
      case TokenCheck::kWrong:
        return said(401, "this is not the access token that the server printed when it started");
      case TokenCheck::kMissing:
        return said(401, "an access token is needed: open the address that the server printed (?token=...)");
      case TokenCheck::kFromQuery:
        headers.emplace_back("Set-Cookie",
                             fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict", kTokenCookie, guard.token));
        break;
      case TokenCheck::kFromCookie:
      case TokenCheck::kNotAsked:
        break;
    }
    return std::nullopt;
  }

  [[nodiscard]] Outcome answer(const Request& request) const {
    Outcome out;
    const std::string_view target = view_of(request.target());
    const std::size_t mark = std::min(target.find('?'), target.size());
    const std::string path = decoded(target.substr(0, mark), false);
    const std::string_view query = target.substr(std::min(mark + 1, target.size()));
    if (auto refused = refusal_of(request, query, out.headers)) {
      out.response = *std::move(refused);
      return out;
    }
    const bool is_post = request.method() == http::verb::post;
    const bool is_read = request.method() == http::verb::get || request.method() == http::verb::head;
    if (!is_read && !(is_post && allow_post)) {
      out.headers.emplace_back("Allow", allow_post ? "GET, HEAD, POST" : "GET, HEAD");
      out.response = said(405, "only reading is possible here");
      return out;
    }
    const auto& routes = is_post ? posts : gets;
    const auto at = routes.find(path);
    if (at == routes.end()) {
      out.response = said(404, "there is nothing of this name");
      return out;
    }
    out.route = &at->second;
    if (out.route->kind == Kind::kAsset) {
      out.response.content_type = out.route->content_type, out.asset = out.route->text;
    } else if (out.route->kind != Kind::kEvents) {
      out.response = handled(*out.route, {path, query, is_post ? std::string_view(request.body()) : std::string_view(),
                                          view_of(request[http::field::content_type])});
    }
    return out;
  }

  [[nodiscard]] static WebResponse handled(const Route& route, const WebRequest& request) {
    try {
      return route.handler(request);
    } catch (...) {  // what it says may be no stranger's business
      return said(500, "the server could not answer this");
    }
  }

  WebGuard guard;
  bool allow_post;
  std::map<std::string, Route> gets, posts;
};

WebRoutes::WebRoutes(WebGuard guard, bool allow_post)
    : site_(std::make_unique<Site>(Site{std::move(guard), allow_post, {}, {}})) {}
WebRoutes::~WebRoutes() = default;

void WebRoutes::add(const std::string& path, Route route) {
  auto& routes = route.kind == Kind::kPost ? site_->posts : site_->gets;
  if (path.empty() || path.front() != '/') throw std::invalid_argument("web path \"" + path + "\": must begin with /");
  if (!routes.emplace(path, std::move(route)).second) throw std::invalid_argument("web path " + path + ": given twice");
}

WebRoutes::Answer WebRoutes::answer(std::string_view bytes) const {
  const std::optional<Request> request = parsed(bytes);
  if (!request) return refusal(400);
  const Site::Outcome made = site_->answer(*request);
  const bool is_head = request->method() == http::verb::head;
  if (made.route != nullptr && made.route->kind == Kind::kEvents && !is_head)
    return {head_of(200, "text/event-stream", made.headers) + "\r\nretry: 2000\n\n", 200, made.route->event_source};
  const std::string_view body = made.asset.data() != nullptr ? made.asset : std::string_view(made.response.body);
  std::string out = head_of(made.response.status, made.response.content_type, made.headers) +
                    fmt::format("Content-Length: {}\r\n\r\n", body.size());
  if (!is_head) out += body;
  return {std::move(out), made.response.status, -1};
}

WebRoutes::Answer WebRoutes::refusal(int status) {
  const std::string text(view_of(http::obsolete_reason(http::int_to_status(static_cast<unsigned>(status)))));
  const std::string body = fmt::format("{} {}\n", status, text);
  const Headers further = status == 503 ? Headers{{"Retry-After", "5"}} : Headers{};
  return {head_of(status, kText, further) + fmt::format("Content-Length: {}\r\n\r\n{}", body.size(), body), status, -1};
}

}  // namespace tools

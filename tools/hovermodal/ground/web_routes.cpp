#include "tools/hovermodal/ground/web_routes.h"

#include <fmt/format.h>
#include <httplib.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace tools {
namespace {

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

// A stream in memory: holds a complete request and collects the answer.
class MemoryStream : public httplib::Stream {
 public:
  explicit MemoryStream(std::string_view request) : request_(request) {}
  [[nodiscard]] bool is_readable() const override { return !request_.empty(); }
  [[nodiscard]] bool is_writable() const override { return true; }
  ssize_t read(char* to, size_t size) override {
    const std::size_t n = request_.copy(to, size);
    request_.remove_prefix(n);
    return static_cast<ssize_t>(n);
  }
  ssize_t write(const char* from, size_t size) override {
    answer.append(from, size);
    return static_cast<ssize_t>(size);
  }
  void get_remote_ip_and_port(std::string&, int&) const override {}
  void get_local_ip_and_port(std::string&, int&) const override {}
  [[nodiscard]] socket_t socket() const override { return INVALID_SOCKET; }

  std::string answer;

 private:
  std::string_view request_;
};

void say(httplib::Response& response, int status, const std::string& text) {
  response.status = status;
  response.set_content(text + "\n", kText);
}

const char* status_text(int status) {
  switch (status) {
    case 408:
      return "Request Timeout";
    case 413:
      return "Content Too Large";
    case 431:
      return "Request Header Fields Too Large";
    case 501:
      return "Not Implemented";
    case 503:
      return "Service Unavailable";
    default:
      return "Bad Request";
  }
}

std::string_view query_of(std::string_view target) {
  const std::size_t at = target.find('?');
  return at == target.npos ? std::string_view{} : target.substr(at + 1);
}

}  // namespace

// Uses httplib's parser and formatting of answers, but not its sockets, routes or files.
struct WebRoutes::Parser : httplib::Server {
  Parser(WebGuard who, bool can_post) : guard(std::move(who)), allow_post(can_post) {
    httplib::Headers headers;
    for (const auto& [name, value] : kSafetyHeaders) headers.emplace(name, value);
    set_default_headers(std::move(headers));
    set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      route(request, response);
      // httplib reads the body; Post("(.*)") then continues in dispatch().
      return is_reading_body ? HandlerResponse::Unhandled : HandlerResponse::Handled;
    });
    Post(".*",
         [this](const httplib::Request& request, httplib::Response& response) { run(*found, request, response); });
    set_exception_handler([](const httplib::Request&, httplib::Response& response, std::exception_ptr) {
      say(response, 500, "the server could not answer this");
    });
  }

  [[nodiscard]] bool is_allowed(const httplib::Request& request, httplib::Response& response) const {
    if (request.get_header_value_count("Host") > 1) return say(response, 400, "Host is said twice"), false;
    const std::string host = request.get_header_value("Host"), origin = request.get_header_value("Origin");
    const std::string site = request.get_header_value("Sec-Fetch-Site"),
                      mode = request.get_header_value("Sec-Fetch-Mode");
    const std::string dest = request.get_header_value("Sec-Fetch-Dest");
    if (const std::string why = refused_origin(guard, {host, origin, site, mode, dest}); !why.empty()) {
      return say(response, 403, why), false;
    }
    switch (check_token(guard, request.get_param_value("token"), request.get_header_value("Cookie"))) {
      case TokenCheck::kWrong:
        return say(response, 401, "this is not the access token that the server printed when it started"), false;
      case TokenCheck::kMissing:
        return say(response, 401, "an access token is needed: open the address that the server printed (?token=...)"),
               false;
      case TokenCheck::kFromQuery:
        response.set_header("Set-Cookie",
                            fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict", kTokenCookie, guard.token));
        break;
      case TokenCheck::kFromCookie:
      case TokenCheck::kNotAsked:
        break;
    }
    return true;
  }

  void route(const httplib::Request& request, httplib::Response& response) {
    found = nullptr, is_reading_body = false;
    if (!is_allowed(request, response)) return;
    const bool is_post = request.method == "POST";
    if (request.method != "GET" && request.method != "HEAD" && !(is_post && allow_post)) {
      response.set_header("Allow", allow_post ? "GET, HEAD, POST" : "GET, HEAD");
      return say(response, 405, "only reading is possible here");
    }
    const auto at = (is_post ? posts : gets).find(request.path);
    if (at == (is_post ? posts : gets).end()) return say(response, 404, "there is nothing of this name");
    found = &at->second;
    is_reading_body = is_post;
    if (!is_post) run(*found, request, response);
  }

  static void run(const Route& route, const httplib::Request& request, httplib::Response& response) {
    if (route.kind == Kind::kAsset) {
      response.status = 200;
      return response.set_content(route.text.data(), route.text.size(), route.content_type);
    }
    if (route.kind == Kind::kEvents) return;  // answer() writes the head
    const std::string type = request.get_header_value("Content-Type");
    WebResponse made = route.handler({request.path, query_of(request.target), request.body, type});
    response.status = made.status;
    response.set_content(std::move(made.body), made.content_type);
  }

  std::string answer(std::string_view request, int& status) {
    MemoryStream stream(request);
    bool is_closed = false;
    status = 400;
    found = nullptr, is_reading_body = false;
    set_logger([&status](const httplib::Request&, const httplib::Response& response) { status = response.status; });
    process_request(stream, true, is_closed, [](httplib::Request& parsed) {
      parsed.ranges.clear();  // many ranges of one text would multiply the size of the answer
      for (const char* name : {"Range", "Accept-Encoding", "Expect"}) parsed.headers.erase(name);
    });
    return std::move(stream.answer);
  }

  WebGuard guard;
  bool allow_post;
  std::map<std::string, Route> gets, posts;
  const Route* found = nullptr;  // of the current request
  bool is_reading_body = false;
};

WebRoutes::WebRoutes(WebGuard guard, bool allow_post)
    : parser_(std::make_unique<Parser>(std::move(guard), allow_post)) {}
WebRoutes::~WebRoutes() = default;

void WebRoutes::add(const std::string& path, Route route) {
  auto& routes = route.kind == Kind::kPost ? parser_->posts : parser_->gets;
  if (path.empty() || path.front() != '/') throw std::invalid_argument("web path \"" + path + "\": must begin with /");
  if (!routes.emplace(path, std::move(route)).second) throw std::invalid_argument("web path " + path + ": given twice");
}

WebRoutes::Answer WebRoutes::answer(std::string_view request) {
  Answer out;
  out.bytes = parser_->answer(request, out.status);
  if (out.bytes.empty()) return refusal(400);
  const Route* route = parser_->found;
  if (route == nullptr || route->kind != Kind::kEvents || request.substr(0, 4) != "GET ") return out;
  out.event_source = route->event_source;
  out.status = 200;
  out.bytes = "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nConnection: close\r\n";
  for (const auto& [name, value] : kSafetyHeaders) out.bytes += fmt::format("{}: {}\r\n", name, value);
  out.bytes += "\r\nretry: 2000\n\n";
  return out;
}

WebRoutes::Answer WebRoutes::refusal(int status) {
  const char* text = status_text(status);
  std::string head = fmt::format("HTTP/1.1 {} {}\r\nConnection: close\r\nContent-Type: {}\r\n", status, text, kText);
  for (const auto& [name, value] : kSafetyHeaders) head += fmt::format("{}: {}\r\n", name, value);
  if (status == 503) head += "Retry-After: 5\r\n";
  const std::string body = fmt::format("{} {}\n", status, text);
  return {head + fmt::format("Content-Length: {}\r\n\r\n{}", body.size(), body), status, -1};
}

}  // namespace tools

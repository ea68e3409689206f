#include "tools/hovermodal/ground/web_server.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tools/hovermodal/ground/web_connections.h"
#include "tools/hovermodal/ground/web_routes.h"

namespace tools {
namespace {

void check(const WebOptions& options) {
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  const std::string& address = options.bind_address;
  const bool is_address =
      inet_pton(AF_INET, address.c_str(), bytes.data()) == 1 || inet_pton(AF_INET6, address.c_str(), bytes.data()) == 1;
  if (!is_address) {
    throw std::invalid_argument(fmt::format(
        "--bind \"{}\": an address of this computer in figures is needed, e.g. 127.0.0.1 (this computer alone), "
        "192.168.1.5, or 0.0.0.0 (every network it is on)",
        address));
  }
  if (options.port < 0 || options.port > 65535) {
    throw std::invalid_argument(fmt::format("--port {}: 0 (any that is free) to 65535", options.port));
  }
  if (options.token.empty() && !is_loopback(address)) {
    throw std::invalid_argument(
        fmt::format("--bind {}: others can reach this address: an access token is needed", address));
  }
  if (options.token.empty()) return;
  if (const std::string why = refused_token(options.token); !why.empty()) {
    throw std::invalid_argument("the access token cannot be used: " + why);
  }
}

}  // namespace

struct WebServer::Parts {
  explicit Parts(WebOptions given)
      : options(std::move(given)),
        routes({options.token, options.known_names, is_loopback(options.bind_address)}, options.allow_post) {}

  WebOptions options;
  WebRoutes routes;
  std::vector<WebConnections::Events> events;
  std::unique_ptr<WebConnections> connections;  // null: not started
  std::thread thread;
};

WebServer::WebServer(WebOptions options) {
  check(options);
  parts_ = std::make_unique<Parts>(std::move(options));
}

WebServer::~WebServer() { stop(); }

void WebServer::add_asset(const std::string& path, const std::string& content_type, std::string_view text) {
  parts_->routes.add(path, {WebRoutes::Kind::kAsset, content_type, text, {}, -1});
}

void WebServer::add_get(const std::string& path, Handler handler) {
  parts_->routes.add(path, {WebRoutes::Kind::kGet, {}, {}, std::move(handler), -1});
}

void WebServer::add_post(const std::string& path, Handler handler) {
  parts_->routes.add(path, {WebRoutes::Kind::kPost, {}, {}, std::move(handler), -1});
}

void WebServer::add_event_source(const std::string& path, int period_ms, EventSource source) {
  parts_->routes.add(path, {WebRoutes::Kind::kEvents, {}, {}, {}, static_cast<int>(parts_->events.size())});
  parts_->events.push_back({period_ms, std::move(source), 0});
}

void WebServer::start() {
  auto connections = std::make_unique<WebConnections>(parts_->routes, parts_->events, parts_->options.limits);
  connections->listen(parts_->options.bind_address, parts_->options.port);
  parts_->connections = std::move(connections);
  parts_->thread = std::thread([this] { parts_->connections->run(); });
}

void WebServer::stop() noexcept {
  if (!parts_->thread.joinable()) return;
  parts_->connections->stop();
  parts_->thread.join();
}

int WebServer::port() const noexcept { return parts_->connections ? parts_->connections->port() : 0; }

std::string WebServer::url() const {
  const std::string& address = parts_->options.bind_address;
  const bool is_v6 = address.find(':') != address.npos;
  const std::string query = parts_->options.token.empty() ? "" : "?token=" + parts_->options.token;
  return fmt::format("http://{}{}{}:{}/{}", is_v6 ? "[" : "", address, is_v6 ? "]" : "", port(), query);
}

WebServer::Counts WebServer::counts() const { return parts_->connections ? parts_->connections->counts() : Counts{}; }

}  // namespace tools

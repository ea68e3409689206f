#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "firmware_app/config/config.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/raw_http.h"
#include "tools/hovermodal/ground/web_head.h"
#include "tools/hovermodal/ground/web_routes.h"
#include "tools/hovermodal/ground/web_server.h"
#include "tools/hovermodal/regions/picker.h"
#include "tools/hovermodal/regions/regions_text.h"

namespace tests::fuzz {
namespace {

using tools::WebRequest;
using tools::WebResponse;
using tools::WebRoutes;

constexpr std::string_view kToken = "0123456789abcdef0123456789abcdef";
constexpr std::string_view kPage = "<!doctype html>page";
constexpr std::size_t kMostHead = 8192, kMostBody = 65536;
constexpr std::uint8_t kWithToken = 1, kWithPost = 2, kThroughSocket = 4;

WebResponse answer_to(const WebRequest& request) {
  require(request.path.starts_with('/'), "a handler is asked for its path");
  require(request.body.size() <= kMostBody, "a body is bounded");
  return {200, "application/json", "[" + std::to_string(request.query.size() + request.body.size()) + "]"};
}

// As `hovermodal regions --serve` handles what its page saves, except for the file.
WebResponse save_regions(const WebRequest& request) {
  std::vector<core::Region> regions;
  try {
    regions = tools::read_regions(request.body, 640, 480);
  } catch (const std::invalid_argument& error) {
    return {422, "text/plain; charset=utf-8", error.what()};
  }
  const std::string json = tools::regions_json(regions, 640, 480);
  require(tools::regions_json(tools::read_regions(json, 640, 480), 640, 480) == json,
          "written and read, it is the same");
  const app::AppConfig config = app::parse_config("camera: {source: a.mp4}\n" + tools::regions_yaml(regions), "saved");
  require(config.regions.size() == regions.size(), "a configuration takes what was saved");
  return {200, "application/json", json};
}

std::unique_ptr<WebRoutes> site(bool with_token, bool with_post) {
  auto routes = std::make_unique<WebRoutes>(tools::WebGuard{with_token ? std::string(kToken) : "", {"station"}, false},
                                            with_post);
  routes->add("/", {WebRoutes::Kind::kAsset, "text/html; charset=utf-8", kPage, {}, -1});
  routes->add("/snapshot.json", {WebRoutes::Kind::kGet, {}, {}, &answer_to, -1});
  routes->add("/change", {WebRoutes::Kind::kPost, {}, {}, &answer_to, -1});
  routes->add("/regions", {WebRoutes::Kind::kPost, {}, {}, &save_regions, -1});
  routes->add("/events", {WebRoutes::Kind::kEvents, {}, {}, {}, 0});
  return routes;
}

void check(const WebRoutes::Answer& answer, std::string_view request, bool with_token, bool with_post) {
  require(answer.bytes.starts_with("HTTP/1."), "an answer is one");
  require(answer.status >= 200 && answer.status < 600, "its status is one");
  require(answer.status != 500, "no handler throws: neither what it is made of, nor a violation in it");
  const std::string_view head = std::string_view(answer.bytes).substr(0, answer.bytes.find("\r\n\r\n"));
  require(head.size() < answer.bytes.size(), "its head ends");
  require(head.find("Content-Security-Policy: default-src 'self'") != head.npos || answer.status == 400,
          "every page that is shown carries the policy");
  const bool is_given = answer.status < 300 || answer.event_source >= 0;
  if (with_token && is_given) require(request.find(kToken) != request.npos, "nothing is given without the token");
  if (is_given && request.starts_with("POST")) require(with_post, "nothing is changed where only reading is possible");
  require(with_token || head.find("Set-Cookie") == head.npos, "no cookie without a token");
}

// Through the server's own sockets: connections, deadlines, event streams.
void ask_server(std::string_view request) {
  static const std::unique_ptr<tools::WebServer> server = [] {
    auto made = std::make_unique<tools::WebServer>(tools::WebOptions{});
    made->add_asset("/", "text/html; charset=utf-8", kPage);
    made->add_get("/snapshot.json", &answer_to);
    made->add_event_source("/events", 10, [] { return std::optional<std::string>("{}"); });
    made->start();
    return made;
  }();
  // An address has 28 000 ports, each of which stays closed for a minute: one address would soon be exhausted.
  static std::uint8_t source = 0;
  source = static_cast<std::uint8_t>(source % 250 + 1);
  RawConnection connection(server->port(), source);
  require(connection.is_open(),
          (std::string("the server takes connections: ") + std::strerror(connection.error())).c_str());
  const std::size_t half = request.size() / 2;
  if (!connection.send(request.substr(0, half)) || !connection.send(request.substr(half))) return;
  connection.end();
  const std::string answer = connection.receive("\r\n\r\n");
  require(answer.empty() || answer.starts_with("HTTP/1."), "an answer is one");
  require(!answer.starts_with("HTTP/1.1 500"), "no handler throws");
}

// The first byte selects set-up and access of the server; the rest is sent by the client.
void run(Bytes bytes) {
  static const std::array sites{site(false, false), site(true, false), site(false, true), site(true, true)};
  Input input(bytes);
  const std::uint8_t setup = input.byte();
  const std::string request = text_of(input.rest());
  if ((setup & kThroughSocket) != 0) return ask_server(request);
  const tools::HeadProgress progress = tools::look_at_head(request, kMostHead, kMostBody);
  if (progress.state == tools::HeadProgress::kNeedsMore) return;
  const bool with_token = (setup & kWithToken) != 0, with_post = (setup & kWithPost) != 0;
  if (progress.state == tools::HeadProgress::kRefused) {
    require(progress.status >= 400, "a refusal has its status");
    return check(WebRoutes::refusal(progress.status), request, with_token, with_post);
  }
  require(progress.n_head <= kMostHead && progress.n_body <= kMostBody, "a request is bounded");
  require(progress.n_head + progress.n_body <= request.size(), "a whole request is there");
  const std::string_view whole = std::string_view(request).substr(0, progress.n_head + progress.n_body);
  check(sites[setup & 3U]->answer(whole), whole, with_token, with_post);
}

const Registration kTarget("http", &run);

}  // namespace
}  // namespace tests::fuzz

#ifdef HOVERMODAL_WITH_GROUND
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <random>

#include "tests/support/raw_http.h"
#include "tools/hovermodal/ground/web_server.h"

namespace {

using tests::get;
using tests::raw_http;
using tests::RawConnection;
using tests::status_of;
using tools::WebOptions;
using tools::WebRequest;
using tools::WebResponse;
using tools::WebServer;

constexpr const char* kToken = "0123456789abcdef0123456789abcdef";

struct Site {
  explicit Site(WebOptions options = {}) : server(std::move(options)) {
    server.add_asset("/", "text/html; charset=utf-8", "<!doctype html>home");
    server.add_get("/now.json", [](const WebRequest& r) {
      return WebResponse{200, "application/json", "[\"" + std::string(r.query) + "\"]"};
    });
    server.add_get("/broken", [](const WebRequest&) -> WebResponse { throw std::runtime_error("a secret"); });
    server.add_post("/change", [](const WebRequest& r) {
      return WebResponse{200, "text/plain", "got " + std::string(r.body)};
    });
    server.add_event_source("/events", 50, [this] { return std::optional<std::string>(std::to_string(++n_events)); });
    server.start();
  }
  [[nodiscard]] std::string ask(const std::string& request) const { return raw_http(server.port(), request); }

  std::atomic<int> n_events{0};
  WebServer server;
};

TEST(GroundWeb, ServesItsPathsWithAStrictPolicyAndNothingElse) {
  const Site site;
  const std::string home = site.ask(get("/"));
  EXPECT_EQ(status_of(home), 200);
  EXPECT_NE(home.find("home"), home.npos);
  for (const char* header :
       {"Content-Security-Policy: default-src 'self'", "X-Content-Type-Options: nosniff", "X-Frame-Options: DENY",
        "Referrer-Policy: no-referrer", "Cache-Control: no-store", "Connection: close"}) {
    EXPECT_NE(home.find(header), home.npos) << header;
  }
  const std::string head = site.ask("HEAD / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(status_of(head), 200);
  EXPECT_EQ(head.find("home"), head.npos);
  EXPECT_NE(site.ask(get("/now.json?a=1")).find("[\"a=1\"]"), std::string::npos);
  const std::string broken = site.ask(get("/broken"));
  EXPECT_EQ(status_of(broken), 500);
  EXPECT_EQ(broken.find("secret"), broken.npos);
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "PATCH", "CONNECT", "TRACE"}) {
    const int status = status_of(site.ask(std::string(method) + " /change HTTP/1.1\r\nHost: localhost\r\n\r\n"));
    EXPECT_TRUE(status == 405 || status == 400) << method << " " << status;
  }
}

TEST(GroundWeb, NoPathLeadsToAFile) {
  const Site site;
  for (const char* target :
       {"/../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/..%2f..%2fetc/passwd", "/%252e%252e/etc/passwd",
        "//etc/passwd", "/etc/passwd%00.html", "/..\\..\\etc\\passwd", "/./", "/%2e", "http://localhost/etc/passwd",
        "file:///etc/passwd", "/now.json/../../etc/passwd", "/%c0%ae%c0%ae/etc/passwd"}) {
    const std::string answer = site.ask(get(target));
    EXPECT_TRUE(status_of(answer) == 404 || status_of(answer) == 400) << target << ": " << answer.substr(0, 40);
    EXPECT_EQ(answer.find("root:"), answer.npos) << target;
  }
}

TEST(GroundWeb, RefusesOtherOriginsAndReboundNames) {
  const Site site;
  EXPECT_EQ(status_of(site.ask(get("/", "", "evil.example"))), 403);
  EXPECT_EQ(status_of(site.ask(get("/events", "", "evil.example"))), 403);
  EXPECT_EQ(status_of(site.ask(get("/", "Origin: http://evil.example\r\n"))), 403);
  EXPECT_EQ(status_of(site.ask(get("/", "Sec-Fetch-Site: cross-site\r\n"))), 403);
  EXPECT_EQ(status_of(site.ask(get("/", "Host: evil.example\r\n"))), 400) << "two hosts";
  EXPECT_EQ(status_of(site.ask("GET / HTTP/1.0\r\n\r\n")), 403) << "none";
  EXPECT_EQ(status_of(site.ask(get("/", "Origin: http://127.0.0.1\r\nSec-Fetch-Site: same-origin\r\n"))), 200);
}

TEST(GroundWeb, AsksForTheTokenOnceAndKeepsItInACookieNoScriptReads) {
  WebOptions options;
  options.token = kToken;
  const Site site(options);
  for (const char* path : {"/", "/now.json", "/events", "/nothing"})
    EXPECT_EQ(status_of(site.ask(get(path))), 401) << path;
  EXPECT_EQ(status_of(site.ask(get("/?token=wrong"))), 401);
  EXPECT_EQ(status_of(site.ask(get("/?token=" + std::string(kToken) + "0"))), 401);
  const std::string home = site.ask(get("/?token=" + std::string(kToken)));
  EXPECT_EQ(status_of(home), 200);
  EXPECT_NE(home.find("Set-Cookie: hovermodal_token=" + std::string(kToken) + "; Path=/; HttpOnly; SameSite=Strict"),
            home.npos);
  EXPECT_EQ(status_of(site.ask(get("/now.json", "Cookie: hovermodal_token=" + std::string(kToken) + "\r\n"))), 200);
  EXPECT_EQ(status_of(site.ask(get("/now.json", "Cookie: hovermodal_token=wrong\r\n"))), 401);
}

TEST(GroundWeb, ANetworkAddressNeedsAToken) {
  WebOptions options;
  options.bind_address = "0.0.0.0";
  EXPECT_THROW(WebServer server(options), std::invalid_argument);
  options.token = "short";
  EXPECT_THROW(WebServer server(options), std::invalid_argument);
  options.token = kToken;
  EXPECT_NO_THROW(WebServer server(options));
  options.bind_address = "localhost";
  EXPECT_THROW(WebServer server(options), std::invalid_argument);
}

TEST(GroundWeb, TooMuchIsRefused) {
  WebOptions options;
  options.allow_post = true;
  const Site site(options);
  EXPECT_EQ(status_of(site.ask(get("/", "A: " + std::string(20000, 'a') + "\r\n"))), 431);
  EXPECT_EQ(status_of(site.ask(get("/" + std::string(9000, 'a')))), 431);
  std::string many;
  for (int i = 0; i < 2000; ++i) many += "A: b\r\n";
  EXPECT_EQ(status_of(site.ask(get("/", many))), 431);
  const std::string post = "POST /change HTTP/1.1\r\nHost: localhost\r\nContent-Length: ";
  EXPECT_EQ(status_of(site.ask(post + "70000\r\n\r\n")), 413);
  EXPECT_NE(site.ask(post + "5\r\n\r\nhello").find("got hello"), std::string::npos);
  EXPECT_EQ(status_of(site.ask("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n\r\n")), 404)
      << "only what takes one";
  EXPECT_EQ(status_of(site.ask(get("/", "Range: bytes=0-0,0-0,0-0,0-0\r\n"))), 200) << "ranges are not made";
}

TEST(GroundWeb, EventsGoToEveryListenerAndNoMoreListenersThanHaveRoom) {
  WebOptions options;
  options.limits.max_event_streams = 3;
  const Site site(options);
  std::vector<RawConnection> listeners;
  for (int i = 0; i < 4; ++i) {
    listeners.emplace_back(site.server.port());
    listeners.back().send(get("/events"));
    if (i == 3) break;
    EXPECT_NE(listeners.back().receive("data: ").find("text/event-stream"), std::string::npos);
  }
  EXPECT_EQ(status_of(listeners.back().receive()), 503);
  EXPECT_EQ(site.server.counts().event_streams, 3U);
  EXPECT_EQ(status_of(site.ask(get("/"))), 200);
}

TEST(GroundWeb, IdleListenersOfOneAddressDoNotKeepOthersOut) {
  WebOptions options;
  options.limits.max_event_streams = 3;
  const Site site(options);
  std::vector<RawConnection> idle;
  for (int i = 0; i < 3; ++i) {
    idle.emplace_back(site.server.port());
    idle.back().send(get("/events"));
    EXPECT_NE(idle.back().receive("data: ").find("text/event-stream"), std::string::npos);
  }
  for (const std::uint8_t source : {std::uint8_t{2}, std::uint8_t{3}, std::uint8_t{4}}) {
    RawConnection other(site.server.port(), source);
    other.send(get("/events"));
    const std::string answer = other.receive("data: ");
    EXPECT_EQ(status_of(answer), source < 4 ? 200 : 503) << "each address has one then: " << answer;
    idle.push_back(std::move(other));
  }
  EXPECT_EQ(site.server.counts().displaced, 2U);
}

TEST(GroundWeb, TwoHundredSlowClientsDoNotKeepANormalOneWaiting) {
  WebOptions options;
  options.limits.max_connections = 64;
  const Site site(options);
  std::vector<RawConnection> slow;
  for (int i = 0; i < 200; ++i) {
    slow.emplace_back(site.server.port());
    slow.back().send("GET / HTTP/1.1\r\nHo");
    if (i % 10 != 0) continue;
    EXPECT_EQ(status_of(site.ask(get("/"))), 200) << i;
  }
  EXPECT_EQ(status_of(site.ask(get("/"))), 200);
  EXPECT_LE(site.server.counts().open, 64U);
  EXPECT_GE(site.server.counts().displaced, 136U);
}

TEST(GroundWeb, ASlowRequestEndsWhenItsTimeIsOver) {
  WebOptions options;
  options.limits.request_ms = 200;
  const Site site(options);
  RawConnection slow(site.server.port());
  slow.send("GET / HT");
  EXPECT_EQ(status_of(slow.receive()), 408);
  EXPECT_EQ(site.server.counts().timed_out, 1U);
}

TEST(GroundWeb, RandomBytesAreRefusedAndHarmNothing) {
  const Site site;
  const std::string good = get("/now.json?x=1", "Accept: */*\r\nCookie: a=b\r\n");
  for (unsigned seed = 1; seed <= 300; ++seed) {
    std::mt19937 draw(seed);
    std::string bytes = good;
    for (unsigned i = 0; i < 1 + draw() % 6; ++i) bytes[draw() % bytes.size()] = static_cast<char>(draw() % 256);
    RawConnection connection(site.server.port());
    connection.send(bytes);
    connection.send("\r\n\r\n");
    (void)connection.receive("HTTP/1.1 ", 2000);
  }
  EXPECT_EQ(status_of(site.ask(get("/"))), 200);
}

}  // namespace
#endif

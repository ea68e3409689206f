#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/hovermodal/ground/web_guard.h"

namespace tools {

// Limits of what strangers can consume. Memory: at most max_connections times (head_bytes + body_bytes + the
// largest answer).
struct WebLimits {
  std::size_t max_connections = 128;   // beyond: the peer with most connections loses its oldest without a request
  std::size_t max_event_streams = 16;  // beyond: 503
  std::size_t head_bytes = 8192;       // request line and headers; beyond: 431
  std::size_t body_bytes = 65536;      // of a POST; beyond: 413
  int request_ms = 5000;               // for a whole request to arrive; beyond: 408
  int response_ms = 10000;             // for the client to read its answer
  int stalled_events_ms = 20000;       // an event stream whose client reads nothing for so long is closed
  int heartbeat_ms = 10000;            // an event stream is never silent for longer
};

struct WebOptions {
  std::string bind_address = "127.0.0.1";  // in figures; IPv4 or IPv6
  int port = 0;                            // 0: any free port
  std::string token;                       // empty: none required; only possible on a loopback address
  std::vector<std::string> known_names;    // names other than addresses by which the page is opened
  bool allow_post = false;
  WebLimits limits;
};

struct WebRequest {
  std::string_view path, query;  // query: as sent, without "?"
  std::string_view body;         // POST only
  std::string_view content_type;
};

struct WebResponse {
  int status = 200;
  std::string content_type = "text/plain; charset=utf-8";
  std::string body;
};

// A small web server for one page and its data, on a network that may be hostile. A fixed set of paths, no files; GET
// and HEAD, and POST where allowed; one request per connection. WebGuard checks every request, and every answer carries
// a strict content security policy. A thread of the server reads, answers and writes without ever waiting for a client
// (Boost.Beast parses requests; answers and sockets are handled here, because a library thread that reads
// from a slow client cannot serve others). Handlers run in that thread, one at a time, and must be quick; they must
// lock data shared with other threads; an exception becomes 500.
//
//   WebServer server({.port = 8086});
//   server.add_asset("/", "text/html; charset=utf-8", page_html());
//   server.add_get("/now.json", [&](const WebRequest&) { return WebResponse{200, "application/json", now()}; });
//   server.add_event_source("/events", 200, [&] { return newest(); });
//   server.start();
class WebServer {
 public:
  using Handler = std::function<WebResponse(const WebRequest&)>;
  // The text of the next event, on one line (JSON); empty: no new event.
  using EventSource = std::function<std::optional<std::string>()>;

  struct Counts {
    std::uint64_t connections = 0, requests = 0, refused = 0;  // refused: answered with 4xx or 503
    std::uint64_t timed_out = 0;                               // request incomplete in time, or answer not read
    std::uint64_t displaced = 0;                               // closed to make room for a newer one
    std::size_t open = 0, event_streams = 0;                   // now
  };

  // Throws std::invalid_argument for an invalid address, port or token, and for an address other than the
  // loopback's without a token.
  explicit WebServer(WebOptions options);
  ~WebServer();  // stops
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  // Before start(). A path begins with "/" and is matched literally, after decoding; a duplicate throws
  // std::invalid_argument. An asset's text must outlive the server.
  void add_asset(const std::string& path, const std::string& content_type, std::string_view text);
  void add_get(const std::string& path, Handler handler);
  void add_post(const std::string& path, Handler handler);  // answered with 405 unless options.allow_post
  // Server-sent events: `source` is called every `period_ms` while there are listeners, which all get the same. A
  // listener that could not accept an event gets an event "resync" as soon as it can.
  void add_event_source(const std::string& path, int period_ms, EventSource source);

  // Binds and begins to answer. Throws std::system_error when the address cannot be used.
  void start();
  void stop() noexcept;

  [[nodiscard]] int port() const noexcept;
  // "http://127.0.0.1:8086/", with the token if one is required.
  [[nodiscard]] std::string url() const;
  [[nodiscard]] Counts counts() const;  // any thread

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace tools

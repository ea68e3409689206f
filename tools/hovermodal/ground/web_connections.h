#pragma once

#include <atomic>
#include <cstdint>
#include <list>
#include <memory>
#include <string>
#include <vector>

#include "tools/hovermodal/ground/web_head.h"
#include "tools/hovermodal/ground/web_routes.h"
#include "tools/hovermodal/ground/web_socket.h"

namespace tools {

// The sockets: one poll loop that never waits for a single one. A connection carries one request, gets one answer or a
// stream of events, and has a deadline in each of its states.
class WebConnections {
 public:
  struct Events {
    int period_ms = 200;
    WebServer::EventSource source;
    std::int64_t due_ms = 0;
  };

  WebConnections(WebRoutes& routes, std::vector<Events> events, const WebLimits& limits);
  ~WebConnections();
  WebConnections(const WebConnections&) = delete;
  WebConnections& operator=(const WebConnections&) = delete;

  // Throws std::system_error.
  void listen(const std::string& address, int port);
  void run();            // until stop()
  void stop() noexcept;  // any thread

  [[nodiscard]] int port() const noexcept { return port_; }
  [[nodiscard]] WebServer::Counts counts() const noexcept;  // any thread

 private:
  enum class State { kReading, kWriting, kStreaming, kEnding };
  struct Connection {
    int fd = -1;
    PeerAddress peer{};
    State state = State::kReading;
    std::string in, out;
    std::size_t n_sent = 0;  // of `out`
    std::int64_t deadline_ms = 0, heartbeat_ms = 0;
    int event_source = -1;
    bool missed_event = false;
    bool is_over = false;
  };

  void accept_all(std::int64_t now_ms);
  void make_room();
  [[nodiscard]] bool has_stream_for(const PeerAddress& peer) noexcept;
  void serve(Connection& c, short events, std::int64_t now_ms);
  void read(Connection& c, std::int64_t now_ms);
  void answer(Connection& c, const HeadProgress& progress, std::int64_t now_ms);
  void reply(Connection& c, WebRoutes::Answer answer, std::int64_t now_ms);
  void write(Connection& c, std::int64_t now_ms);
  void written(Connection& c, std::int64_t now_ms);
  void drain(Connection& c);
  void send_events(std::int64_t now_ms);
  void send_event(Connection& c, const std::string& text, std::int64_t now_ms);
  void look_at_deadlines(std::int64_t now_ms);
  void sweep();

  WebRoutes& routes_;
  std::vector<Events> events_;
  WebLimits limits_;
  int listener_ = -1, wake_ = -1, port_ = 0;
  std::list<Connection> connections_;  // oldest first
  std::size_t n_streams_ = 0;
  std::atomic<bool> stop_{false};  // set by stop(), read by run()
  // Written by run() only; relaxed: each counter is independent of other data.
  std::atomic<std::uint64_t> n_connections_{0}, n_requests_{0}, n_refused_{0}, n_timed_out_{0}, n_displaced_{0};
  std::atomic<std::size_t> n_open_{0}, n_event_streams_{0};
};

}  // namespace tools

#include "tools/hovermodal/ground/web_connections.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <map>
#include <system_error>
#include <utility>

namespace tools {
namespace {

constexpr int kTick_ms = 50;
constexpr int kMostAcceptedAtOnce = 64;
constexpr std::size_t kReadBytes = 16384;
constexpr int kEnding_ms = 1000;  // for the client to read the answer before the socket is closed
constexpr const char* kHeartbeat = ":\n\n";
constexpr const char* kResync = "event: resync\ndata: {}\n\n";

std::int64_t clock_ms() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

void add(std::atomic<std::uint64_t>& count) {
  count.store(count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

bool would_block() { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }

}  // namespace

WebConnections::WebConnections(WebRoutes& routes, std::vector<Events> events, const WebLimits& limits)
    : routes_(routes), events_(std::move(events)), limits_(limits), wake_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (wake_ < 0) throw std::system_error(errno, std::generic_category(), "web server");
}

WebConnections::~WebConnections() {
  for (const Connection& c : connections_) close(c.fd);
  if (listener_ >= 0) close(listener_);
  close(wake_);
}

void WebConnections::listen(const std::string& address, int port) {
  const ListeningSocket bound = listen_on(address, port);
  listener_ = bound.fd, port_ = bound.port;
}

void WebConnections::stop() noexcept {
  stop_.store(true, std::memory_order_release);
  const std::uint64_t one = 1;
  (void)!::write(wake_, &one, sizeof one);
}

void WebConnections::run() {
  std::vector<pollfd> polled;
  while (!stop_.load(std::memory_order_acquire)) {
    polled.assign({{wake_, POLLIN, 0}, {listener_, POLLIN, 0}});
    for (const Connection& c : connections_) {
      const bool writes = c.n_sent < c.out.size();
      polled.push_back({c.fd, static_cast<short>(writes ? POLLOUT : POLLIN), 0});
    }
    poll(polled.data(), polled.size(), kTick_ms);
    const std::int64_t now_ms = clock_ms();
    std::size_t i = 2;
    for (Connection& c : connections_) serve(c, polled[i++].revents, now_ms);
    if (polled[1].revents != 0) accept_all(now_ms);
    send_events(now_ms);
    look_at_deadlines(now_ms);
    sweep();
  }
}

void WebConnections::accept_all(std::int64_t now_ms) {
  for (int i = 0; i < kMostAcceptedAtOnce; ++i) {
    if (connections_.size() >= limits_.max_connections) make_room();
    PeerAddress peer;
    const int fd = accept_next(listener_, peer);
    if (fd < 0) return;
    connections_.push_back({fd, peer, State::kReading, {}, {}, 0, now_ms + limits_.request_ms, 0, -1, false, false});
    add(n_connections_);
    read(connections_.back(), now_ms);  // most requests arrive together with the connection
  }
}

// Of the peer with most connections: closes the oldest without a request, else the oldest that reads its answer slowly.
// Event streams stay. A flood from one address thus does not displace others.
void WebConnections::make_room() {
  sweep();
  if (connections_.size() < limits_.max_connections) return;
  std::map<PeerAddress, int> held;
  for (const Connection& c : connections_) held[c.peer] += c.state == State::kStreaming ? 0 : 1;
  const auto weight = [&](const Connection& c) {
    return c.state == State::kStreaming ? 0 : 2 * held[c.peer] + (c.state == State::kWriting ? 0 : 1);
  };
  const auto chosen =
      std::max_element(connections_.begin(), connections_.end(), [&](const Connection& a, const Connection& b) {
        return weight(a) < weight(b);  // among equal ones the first, and oldest, is chosen
      });
  if (chosen == connections_.end() || weight(*chosen) == 0) return;
  chosen->is_over = true;
  add(n_displaced_);
  sweep();
}

void WebConnections::serve(Connection& c, short events, std::int64_t now_ms) {
  if (events == 0 || c.is_over) return;
  if ((events & (POLLERR | POLLNVAL)) != 0) {
    c.is_over = true;
  } else if ((events & POLLOUT) != 0) {
    write(c, now_ms);
  } else if (c.state == State::kReading) {
    read(c, now_ms);
  } else {
    drain(c);
  }
}

void WebConnections::read(Connection& c, std::int64_t now_ms) {
  std::array<char, kReadBytes> buffer;
  const ssize_t n = recv(c.fd, buffer.data(), buffer.size(), 0);
  if (n <= 0) {
    c.is_over = n == 0 || !would_block();
    return;
  }
  c.in.append(buffer.data(), static_cast<std::size_t>(n));
  const HeadProgress progress = look_at_head(c.in, limits_.head_bytes, limits_.body_bytes);
  if (progress.state == HeadProgress::kNeedsMore) return;
  add(n_requests_);
  answer(c, progress, now_ms);
}

void WebConnections::answer(Connection& c, const HeadProgress& progress, std::int64_t now_ms) {
  WebRoutes::Answer answer;
  if (progress.state == HeadProgress::kRefused) {
    answer = WebRoutes::refusal(progress.status);
  } else {
    answer = routes_.answer(std::string_view(c.in).substr(0, progress.n_head + progress.n_body));
  }
  const bool is_stream = answer.event_source >= 0;
  if (is_stream && n_streams_ >= limits_.max_event_streams && !has_stream_for(c.peer)) answer = WebRoutes::refusal(503);
  reply(c, std::move(answer), now_ms);
}

// Closes the oldest event stream of the peer with most of them, if it still has more than `peer` then. One address thus
// does not keep others out.
bool WebConnections::has_stream_for(const PeerAddress& peer) noexcept {
  const auto n_of = [&](const PeerAddress& of) {
    return std::count_if(connections_.begin(), connections_.end(), [&](const Connection& c) {
      return c.state == State::kStreaming && !c.is_over && c.peer == of;
    });
  };
  Connection* chosen = nullptr;
  std::ptrdiff_t most = n_of(peer) + 1;
  for (Connection& c : connections_) {
    if (c.state != State::kStreaming || c.is_over) continue;
    if (const std::ptrdiff_t n = n_of(c.peer); n > most) chosen = &c, most = n;
  }
  if (chosen == nullptr) return false;
  chosen->is_over = true;  // counted by sweep(): until then there is one more than the limit
  add(n_displaced_);
  return true;
}

void WebConnections::reply(Connection& c, WebRoutes::Answer answer, std::int64_t now_ms) {
  if (answer.status >= 400) add(n_refused_);
  c.event_source = answer.event_source;
  if (c.event_source >= 0) ++n_streams_;
  c.state = c.event_source >= 0 ? State::kStreaming : State::kWriting;
  std::string().swap(c.in);
  c.out = std::move(answer.bytes);
  c.n_sent = 0;
  c.heartbeat_ms = now_ms + limits_.heartbeat_ms;
  c.deadline_ms = now_ms + (c.event_source >= 0 ? limits_.stalled_events_ms : limits_.response_ms);
  write(c, now_ms);
}

void WebConnections::write(Connection& c, std::int64_t now_ms) {
  while (c.n_sent < c.out.size()) {
    const ssize_t n = send(c.fd, c.out.data() + c.n_sent, c.out.size() - c.n_sent, MSG_NOSIGNAL);
    if (n < 0) {
      c.is_over = !would_block();
      return;
    }
    c.n_sent += static_cast<std::size_t>(n);
    if (c.state == State::kStreaming) c.deadline_ms = now_ms + limits_.stalled_events_ms;
  }
  written(c, now_ms);
}

void WebConnections::written(Connection& c, std::int64_t now_ms) {
  std::string().swap(c.out);
  c.n_sent = 0;
  if (c.state == State::kStreaming) {
    if (std::exchange(c.missed_event, false)) send_event(c, kResync, now_ms);
    return;
  }
  // Closing at once would reset a connection with unread bytes, and lose the answer.
  shutdown(c.fd, SHUT_WR);
  c.state = State::kEnding;
  c.deadline_ms = now_ms + kEnding_ms;
}

// Bytes after the request are ignored; only their end matters.
void WebConnections::drain(Connection& c) {
  std::array<char, kReadBytes> buffer;
  const ssize_t n = recv(c.fd, buffer.data(), buffer.size(), 0);
  if (n == 0 || (n < 0 && !would_block())) c.is_over = true;
}

void WebConnections::send_events(std::int64_t now_ms) {
  for (std::size_t i = 0; i < events_.size(); ++i) {
    Events& events = events_[i];
    const auto listens = [i](const Connection& c) { return c.event_source == static_cast<int>(i) && !c.is_over; };
    if (now_ms < events.due_ms || std::none_of(connections_.begin(), connections_.end(), listens)) continue;
    events.due_ms = now_ms + events.period_ms;
    std::optional<std::string> text;
    try {
      text = events.source();
    } catch (...) {  // out of memory: the next event follows soon
    }
    const std::string event = text ? "data: " + *text + "\n\n" : std::string();
    for (Connection& c : connections_) {
      if (!listens(c)) continue;
      if (text) {
        send_event(c, event, now_ms);
      } else if (now_ms >= c.heartbeat_ms && c.out.empty()) {
        send_event(c, kHeartbeat, now_ms);
      }
    }
  }
}

void WebConnections::send_event(Connection& c, const std::string& text, std::int64_t now_ms) {
  if (!c.out.empty()) {  // the last event is not fully sent yet
    c.missed_event = true;
    return;
  }
  c.out = text;
  c.n_sent = 0;
  c.heartbeat_ms = now_ms + limits_.heartbeat_ms;
  c.deadline_ms = now_ms + limits_.stalled_events_ms;
  write(c, now_ms);
}

void WebConnections::look_at_deadlines(std::int64_t now_ms) {
  for (Connection& c : connections_) {
    if (c.is_over || now_ms < c.deadline_ms) continue;
    const bool has_nothing_to_take = c.state == State::kStreaming && c.out.empty();
    if (has_nothing_to_take) continue;
    if (c.state == State::kEnding) {
      c.is_over = true;
      continue;
    }
    add(n_timed_out_);
    if (c.state == State::kReading) {
      reply(c, WebRoutes::refusal(408), now_ms);
    } else {
      c.is_over = true;
    }
  }
}

void WebConnections::sweep() {
  connections_.remove_if([this](const Connection& c) {
    if (!c.is_over) return false;
    close(c.fd);
    if (c.event_source >= 0) --n_streams_;
    return true;
  });
  n_open_.store(connections_.size(), std::memory_order_relaxed);
  n_event_streams_.store(n_streams_, std::memory_order_relaxed);
}

WebServer::Counts WebConnections::counts() const noexcept {
  const auto of = [](const auto& count) { return count.load(std::memory_order_relaxed); };
  return {of(n_connections_), of(n_requests_), of(n_refused_),      of(n_timed_out_),
          of(n_displaced_),   of(n_open_),     of(n_event_streams_)};
}

}  // namespace tools

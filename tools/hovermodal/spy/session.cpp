#include "tools/hovermodal/spy/session.h"

#include <stdexcept>

#ifndef HOVERMODAL_WITH_LCM

void tools::run_spy(const SpyOptions&) {
  throw std::runtime_error(
      "spy: this build has no LCM. Install liblcm-dev, liblcm-bin and libglib2.0-dev and configure again with "
      "-DWITH_LCM=ON.");
}

#else

#include <fmt/format.h>
#include <lcm/lcm.h>
#include <signal.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <memory>
#include <optional>

#include "drivers/telemetry/lcm_self_test.h"
#include "drivers/telemetry/lcm_url.h"
#include "drivers/telemetry/stream_monitor.h"
#include "tools/hovermodal/spy/count.h"
#include "tools/hovermodal/spy/stages.h"
#include "tools/hovermodal/spy/terminal.h"
#include "tools/hovermodal/spy/view.h"

namespace tools {
namespace {

constexpr int kPoll_ms = 50;
constexpr std::int64_t kRedraw_ns = 250'000'000;
constexpr std::int64_t kPlainLine_ns = 1'000'000'000;
constexpr std::int64_t kAfterEnd_ns = 500'000'000;  // for what is still under way when the final health arrives
// LCM keeps 30 messages by default and drops the rest while we draw.
constexpr int kQueuedMessages = 20000;
constexpr const char* kReceiveBuffer = "recv_buf_size=4194304";  // bytes; the kernel cuts it to net.core.rmem_max

volatile sig_atomic_t stop_requested = 0;

extern "C" void request_stop(int) { stop_requested = 1; }

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

extern "C" void on_message(const lcm_recv_buf_t* buffer, const char* channel, void* monitor) {
  static_cast<drivers::StreamMonitor*>(monitor)->receive(channel, buffer->data, buffer->data_size, now_ns());
}

class Listener {
 public:
  Listener(const SpyOptions& options, drivers::StreamMonitor& monitor) : lcm_(nullptr, &lcm_destroy) {
    drivers::check_channel_prefix(options.prefix);
    const auto test = drivers::run_lcm_self_test(options.url, options.prefix);
    if (!test.heard) throw std::runtime_error(test.message);
    lcm_.reset(lcm_create(with_receive_buffer(options.url).c_str()));
    if (!lcm_) {
      throw std::runtime_error(fmt::format("LCM cannot open \"{}\" (its own words are on stderr). The usual URL is {}",
                                           options.url, drivers::kDefaultLcmUrl));
    }
    const std::string pattern = drivers::topics_pattern(options.prefix);
    lcm_subscription_t* subscription = lcm_subscribe(lcm_.get(), pattern.c_str(), &on_message, &monitor);
    if (subscription == nullptr) throw std::runtime_error(fmt::format("LCM cannot listen on \"{}\"", options.url));
    lcm_subscription_set_queue_capacity(subscription, kQueuedMessages);
  }

  // Waits up to kPoll_ms for a message and takes all that are there (within reason: the screen and signals wait
  // meanwhile). False at the end of a log.
  bool poll() {
    constexpr int kMaxBatch = 1000;
    for (int i = 0; i < kMaxBatch; ++i) {
      errno = 0;
      const int n = lcm_handle_timeout(lcm_.get(), i == 0 ? kPoll_ms : 0);
      if (n < 0) return errno == EINTR;
      if (n == 0) return true;
    }
    return true;
  }

 private:
  static std::string with_receive_buffer(const std::string& url) {
    if (!drivers::is_udpm(url) || drivers::parse_udpm(url).has_recv_buf_size) return url;
    return url + (url.find('?') == url.npos ? "?" : "&") + kReceiveBuffer;
  }

  std::unique_ptr<lcm_t, decltype(&lcm_destroy)> lcm_;
};

std::vector<std::string> render(SpyView what, const drivers::StreamMonitor& monitor, const ViewOptions& view) {
  return what == SpyView::kModes ? render_screen(monitor, view) : render_stages(monitor, view);
}

// Plain lines: a status each second, the modes whenever they are new and whole.
class PlainOutput {
 public:
  explicit PlainOutput(SpyView what) : what_(what) {}

  void update(const drivers::StreamMonitor& monitor, const ViewOptions& view) {
    what_ == SpyView::kModes ? update_modes(monitor, view) : update_stages(monitor, view);
    std::fflush(stdout);
  }

 private:
  void update_modes(const drivers::StreamMonitor& monitor, const ViewOptions& view) {
    update_versions(monitor, view);
    const auto& estimate = monitor.estimate();
    if (estimate && estimate->number != shown_estimate_ && monitor.parts_heard() >= estimate->n_parts) {
      shown_estimate_ = estimate->number;
      for (const auto& line : render_modes(monitor, view, 32)) std::printf("%s\n", line.c_str());
    }
    if (view.now_ns - last_line_ns_ >= kPlainLine_ns && monitor.last_received_ns() != 0) {
      last_line_ns_ = view.now_ns;
      std::printf("%s\n", render_status(monitor, view).c_str());
    }
  }
  // Said once for each that is heard.
  void update_versions(const drivers::StreamMonitor& monitor, const ViewOptions& view) {
    const std::size_t n = monitor.other_versions().size();
    if (n == n_versions_) return;
    n_versions_ = n;
    for (const auto& line : render_versions(monitor, view)) std::printf("%s\n", line.c_str());
  }
  void update_stages(const drivers::StreamMonitor& monitor, const ViewOptions& view) {
    update_versions(monitor, view);
    if (!monitor.health() || monitor.health()->sequence == shown_health_) return;
    shown_health_ = monitor.health()->sequence;
    for (const auto& line : render_stages(monitor, view)) std::printf("%s\n", line.c_str());
  }

  SpyView what_;
  std::size_t n_versions_ = 0;
  std::int64_t shown_health_ = -1;
  std::int64_t shown_estimate_ = -1;
  std::int64_t last_line_ns_ = 0;
};

// How the session ended.
enum class End { kAsked, kTimeOver, kStreamEnded };

End listen(const SpyOptions& options, Listener& listener, drivers::StreamMonitor& monitor, TerminalScreen* screen,
           ViewOptions view) {
  PlainOutput plain(options.view);
  const std::int64_t begin_ns = now_ns();
  std::int64_t drawn_ns = 0;
  for (;;) {
    const bool has_more = listener.poll();
    view.now_ns = now_ns();
    if (screen == nullptr) {
      plain.update(monitor, view);
    } else if (view.now_ns - drawn_ns >= kRedraw_ns) {
      drawn_ns = view.now_ns;
      view.columns = screen->columns();
      view.rows = screen->rows();
      screen->draw(render(options.view, monitor, view));
    }
    if (stop_requested != 0) return End::kAsked;
    if (!has_more) return End::kStreamEnded;
    if (options.once && monitor.is_finished() && view.now_ns - monitor.finished_at_ns() >= kAfterEnd_ns) {
      return End::kStreamEnded;
    }
    if (options.seconds > 0.0 && static_cast<double>(view.now_ns - begin_ns) * 1e-9 >= options.seconds) {
      return End::kTimeOver;
    }
  }
}

void watch_signals() {
  struct sigaction action {};
  action.sa_handler = &request_stop;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

void run_spy(const SpyOptions& options) {
  drivers::StreamMonitor monitor(options.prefix);
  std::ofstream count_file;
  if (!options.count_file.empty()) {
    count_file.open(options.count_file);
    if (!count_file) throw std::runtime_error(fmt::format("--count \"{}\": cannot be written", options.count_file));
  }
  Listener listener(options, monitor);
  watch_signals();
  std::optional<TerminalScreen> screen;
  ViewOptions view;
  if (options.plain || !locale_is_utf8()) view.charset = Charset::kAscii;
  if (!options.plain && stdout_is_terminal()) {
    screen.emplace();
  } else {
    std::printf("listening on %s for %s_*\n", options.url.c_str(), options.prefix.c_str());
    std::fflush(stdout);
  }
  const End end = listen(options, listener, monitor, screen ? &*screen : nullptr, view);
  screen.reset();
  view.now_ns = now_ns();
  for (const auto& line : render(options.view, monitor, view)) std::printf("%s\n", line.c_str());
  count_file << (options.count_file.empty() ? "" : count_json(monitor)) << std::flush;
  if (!options.count_file.empty() && !count_file) {
    throw std::runtime_error(fmt::format("--count \"{}\": cannot be written", options.count_file));
  }
  if (options.once && !monitor.is_finished() && end != End::kAsked) {
    throw std::runtime_error("spy --once: the stream said neither \"finished\" nor \"fault\" before the end");
  }
}

}  // namespace tools
#endif

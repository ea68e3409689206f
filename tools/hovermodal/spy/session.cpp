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

#include <cstdio>
#include <fstream>
#include <optional>

#include "drivers/telemetry/lcm_listener.h"
#include "drivers/telemetry/stream_monitor.h"
#include "tools/hovermodal/spy/count.h"
#include "tools/hovermodal/spy/stages.h"
#include "tools/hovermodal/spy/terminal.h"
#include "tools/hovermodal/spy/view.h"
#include "tools/hovermodal/stop_signal.h"

namespace tools {
namespace {

constexpr std::int64_t kRedraw_ns = 250'000'000;
constexpr std::int64_t kPlainLine_ns = 1'000'000'000;
constexpr std::int64_t kAfterEnd_ns = 500'000'000;  // for messages still under way when the final health arrives

std::vector<std::string> render(SpyView what, const drivers::StreamMonitor& monitor, const ViewOptions& view) {
  return what == SpyView::kModes ? render_screen(monitor, view) : render_stages(monitor, view);
}

// Plain lines: a status each second, the modes whenever they are new and complete.
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
  // Printed once for each other version.
  void update_versions(const drivers::StreamMonitor& monitor, const ViewOptions& view) {
    const std::size_t n = monitor.sender_warnings().size();
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

End listen(const SpyOptions& options, drivers::LcmListener& listener, drivers::StreamMonitor& monitor,
           TerminalScreen* screen, ViewOptions view) {
  PlainOutput plain(options.view);
  const std::int64_t begin_ns = drivers::LcmListener::now_ns();
  std::int64_t drawn_ns = 0;
  for (;;) {
    const bool has_more = listener.poll();
    view.now_ns = drivers::LcmListener::now_ns();
    if (!options.answer.tells()) {
      // Only the end is told.
    } else if (screen == nullptr) {
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

}  // namespace

void run_spy(const SpyOptions& options) {
  drivers::StreamMonitor monitor(options.prefix);
  std::ofstream count_file;
  if (!options.count_file.empty()) {
    count_file.open(options.count_file);
    if (!count_file) throw std::runtime_error(fmt::format("--count \"{}\": cannot be written", options.count_file));
  }
  drivers::LcmListener listener(options.url, options.prefix,
                                [&monitor](std::string_view channel, const void* data, std::size_t n_bytes) {
                                  monitor.receive(channel, data, n_bytes, drivers::LcmListener::now_ns());
                                });
  watch_stop_signals();
  std::optional<TerminalScreen> screen;
  ViewOptions view;
  if (options.plain || !locale_is_utf8()) view.charset = Charset::kAscii;
  if (options.answer.tells() && !options.plain && stdout_is_terminal()) {
    screen.emplace();
  } else {
    options.answer.text("listening on {} for {}_*\n", options.url, options.prefix);
    std::fflush(stdout);
  }
  const End end = listen(options, listener, monitor, screen ? &*screen : nullptr, view);
  screen.reset();
  view.now_ns = drivers::LcmListener::now_ns();
  for (const auto& line : render(options.view, monitor, view)) options.answer.text("{}\n", line);
  options.answer.document(count_json(monitor));
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

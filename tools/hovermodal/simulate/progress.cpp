#include "tools/hovermodal/simulate/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace tools {

Progress::Progress(std::string what, std::uint64_t total, std::string unit, bool is_quiet)
    : what_(std::move(what)),
      unit_(std::move(unit)),
      total_(std::max<std::uint64_t>(total, 1)),
      terminal_(::isatty(STDERR_FILENO) == 1),
      quiet_(is_quiet) {}

Progress::~Progress() {
  if (line_open_) std::fputc('\n', stderr);
}

double Progress::elapsed_s() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

void Progress::update(std::uint64_t done) {
  if (quiet_) return;
  const std::uint64_t tenth = 10 * done / total_;
  const bool due =
      terminal_ ? Clock::now() - last_print_ > std::chrono::milliseconds(200) || done == total_ : tenth > last_tenth_;
  if (due) print(done);
  last_tenth_ = tenth;
}

void Progress::say(const std::string& text) {
  if (quiet_) return;
  fmt::print(stderr, "{}{}\n", line_open_ ? "\r\033[K" : "", text);
  line_open_ = false;
}

void Progress::print(std::uint64_t done) {
  const double elapsed = std::max(elapsed_s(), 1e-9);
  const double per_second = static_cast<double>(done) / elapsed;
  const double left_s = static_cast<double>(total_ - done) / std::max(per_second, 1e-9);
  const std::string left = done > 0 ? fmt::format("{:.0f} s left", left_s) : "";
  const std::string line = fmt::format("{} {:3d} %  {}/{} {}  {:.1f} {}/s  {}", what_, 100 * done / total_, done,
                                       total_, unit_, per_second, unit_, left);
  if (terminal_) {
    constexpr std::uint64_t kBarCells = 24;
    const std::string bar(kBarCells * done / total_, '#');
    fmt::print(stderr, "\r[{:<24}] {}\033[K", bar, line);
    line_open_ = true;
  } else {
    fmt::print(stderr, "{}\n", line);
  }
  std::fflush(stderr);
  last_print_ = Clock::now();
}

}  // namespace tools

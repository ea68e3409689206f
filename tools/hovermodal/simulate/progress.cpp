#include "tools/hovermodal/simulate/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace tools {

Progress::Progress(std::string what, std::uint64_t total)
    : what_(std::move(what)), total_(std::max<std::uint64_t>(total, 1)), terminal_(::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (line_open_) std::fputc('\n', stderr);
}

double Progress::elapsed_s() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

void Progress::update(std::uint64_t done) {
  const std::uint64_t tenth = 10 * done / total_;
  const bool due =
      terminal_ ? Clock::now() - last_print_ > std::chrono::milliseconds(200) || done == total_ : tenth > last_tenth_;
  if (due) print(done);
  last_tenth_ = tenth;
}

void Progress::print(std::uint64_t done) {
  const double elapsed = std::max(elapsed_s(), 1e-9);
  const double per_second = static_cast<double>(done) / elapsed;
  const double left_s = static_cast<double>(total_ - done) / std::max(per_second, 1e-9);
  const std::string line = fmt::format("{} {:3d} %  {}/{} frames  {:.1f} frames/s  {:.0f} s left", what_,
                                       100 * done / total_, done, total_, per_second, left_s);
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

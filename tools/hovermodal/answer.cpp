#include "tools/hovermodal/answer.h"

#include <unistd.h>

#include <chrono>

namespace tools {

void add_answer_options(drivers::Command& command, Answer& answer, const std::string& what) {
  command.flag("--json", answer.json, "Print " + what + " as JSON, in place of the text");
  command.flag("--quiet", answer.quiet, "Print no text, note or progress; files are written");
}

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point then) { return std::chrono::duration<double>(Clock::now() - then).count(); }

// Prints at intervals what it hears.
class ProgressTeller {
 public:
  explicit ProgressTeller(bool terminal) : terminal_(terminal) {}

  void operator()(const core::closure::LoopProgress& now) {
    const bool is_new = now.words != words_;
    if (is_new) words_ = now.words, part_start_ = Clock::now();
    const double every_s = terminal_ ? 0.2 : 5.0;
    if (seconds_since(last_print_) < every_s && !(terminal_ && is_new)) return;
    last_print_ = Clock::now();
    fmt::print(stderr, "{}{}{}, {:.0f} s so far{}", terminal_ ? "\r\033[K" : "", now.words, counted(now),
               seconds_since(start_), terminal_ ? "" : "\n");
    std::fflush(stderr);
  }

 private:
  [[nodiscard]] std::string counted(const core::closure::LoopProgress& now) const {
    if (now.n == 0) return {};
    std::string out = fmt::format(": {} of {}", now.n_done, now.n);
    if (now.n_done > 0) {
      const double each_s = seconds_since(part_start_) / static_cast<double>(now.n_done);
      out += fmt::format(", {:.0f} s left of them at most", each_s * static_cast<double>(now.n - now.n_done));
    }
    return out;
  }

  bool terminal_;
  std::string words_;
  Clock::time_point start_ = Clock::now(), part_start_ = start_, last_print_ = start_;
};

}  // namespace

ProgressLine::ProgressLine(const Answer& answer) : shows_(!answer.quiet), terminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (shows_ && terminal_) std::fputs("\r\033[K", stderr);
}

core::closure::TellProgress ProgressLine::teller() const {
  if (!shows_) return {};
  return ProgressTeller(terminal_);
}

}  // namespace tools

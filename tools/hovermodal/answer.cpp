#include "tools/hovermodal/answer.h"

#include <unistd.h>

#include <chrono>

namespace tools {

void add_answer_options(drivers::Command& command, Answer& answer, const std::string& what) {
  command.flag("--json", answer.json, "Print " + what + " as JSON, in place of the text");
  command.flag("--quiet", answer.quiet, "Print no text, note or progress; files are written");
}

ProgressLine::ProgressLine(const Answer& answer) : shows_(!answer.quiet && ::isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (shows_) std::fputs("\r\033[K", stderr);
}

std::function<void(const std::string& words)> ProgressLine::teller() const {
  if (!shows_) return {};
  const auto start = std::chrono::steady_clock::now();
  return [start](const std::string& words) {
    const std::chrono::duration<double> so_far = std::chrono::steady_clock::now() - start;
    fmt::print(stderr, "\r\033[K{}, {:.0f} s so far", words, so_far.count());
    std::fflush(stderr);
  };
}

}  // namespace tools

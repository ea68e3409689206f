#pragma once

#include <fmt/core.h>

#include <cstdio>
#include <string>

#include "core/types/loop_progress.h"
#include "drivers/host/command_line.h"

namespace tools {

// What a command leaves on its standard streams. Without options: the text of its result on standard output. --json:
// one JSON document on standard output in its place, notes on standard error. --quiet: no text, no notes, no progress;
// with --json, the document alone. Files are written in every case, and errors are always reported.
struct Answer {
  bool json = false, quiet = false;

  [[nodiscard]] bool tells() const noexcept { return !json && !quiet; }

  template <class... Args>
  void text(fmt::format_string<Args...> format, Args&&... args) const {
    if (tells()) fmt::print(format, std::forward<Args>(args)...);
  }
  // What a user should know beside the result. Part of the text, and not lost with --json.
  template <class... Args>
  void note(fmt::format_string<Args...> format, Args&&... args) const {
    if (!quiet) fmt::print(json ? stderr : stdout, format, std::forward<Args>(args)...);
  }
  // `document`: complete, with its last newline.
  void document(const std::string& document) const {
    if (json) fmt::print("{}", document);
  }
};

// `what`: of the document, e.g. "the modes, as modal.json has them".
void add_answer_options(drivers::Command& command, Answer& answer, const std::string& what);

// What residual diagnosis is doing, on standard error: how long so far, and of a part that is counted how long it still
// takes at most (how many parts there are is known at the end only). One line of a terminal; elsewhere a line every
// five seconds; with --quiet nothing.
class ProgressLine {
 public:
  explicit ProgressLine(const Answer& answer);
  ~ProgressLine();  // clears the line
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  // Empty where nothing is shown. Valid without this object.
  [[nodiscard]] core::closure::TellProgress teller() const;

 private:
  bool shows_, terminal_;
};

}  // namespace tools

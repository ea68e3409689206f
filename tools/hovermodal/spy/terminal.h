#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tools {

// The alternate screen of a terminal, for as long as this lives. Redraws in place, without flicker.
class TerminalScreen {
 public:
  TerminalScreen();
  ~TerminalScreen();
  TerminalScreen(const TerminalScreen&) = delete;
  TerminalScreen& operator=(const TerminalScreen&) = delete;
  void draw(const std::vector<std::string>& lines);
  [[nodiscard]] std::size_t columns() const;  // at least 80
  [[nodiscard]] std::size_t rows() const;     // at least 20
};

[[nodiscard]] bool stdout_is_terminal();
[[nodiscard]] bool locale_is_utf8();

}  // namespace tools

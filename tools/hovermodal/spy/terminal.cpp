#include "tools/hovermodal/spy/terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace tools {
namespace {

winsize size() {
  winsize out{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &out) != 0 || out.ws_col == 0) {
    out.ws_col = 100;
    out.ws_row = 30;
  }
  return out;
}

void put(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
}

}  // namespace

TerminalScreen::TerminalScreen() { put("\x1b[?1049h\x1b[?25l\x1b[2J"); }

TerminalScreen::~TerminalScreen() { put("\x1b[?25h\x1b[?1049l"); }

void TerminalScreen::draw(const std::vector<std::string>& lines) {
  std::string out = "\x1b[H";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i > 0) out += "\r\n";
    out += lines[i] + "\x1b[K";
  }
  put(out + "\x1b[J");
}

std::size_t TerminalScreen::columns() const { return std::max<std::size_t>(size().ws_col, 80); }
std::size_t TerminalScreen::rows() const { return std::max<std::size_t>(size().ws_row, 20); }

bool stdout_is_terminal() { return isatty(STDOUT_FILENO) == 1; }

bool locale_is_utf8() {
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const char* value = std::getenv(name);
    if (value == nullptr || *value == '\0') continue;
    const std::string_view text = value;
    return text.find("UTF-8") != text.npos || text.find("utf8") != text.npos || text.find("utf-8") != text.npos;
  }
  return false;
}

}  // namespace tools

#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace drivers {

// Appends `text` as lines of at most `columns` characters, `indent` spaces first; a word longer than that stays whole.
inline void append_wrapped(std::string& out, std::string_view text, std::size_t indent, std::size_t columns = 100) {
  while (!text.empty()) {
    const std::size_t width = columns - indent;
    std::size_t length = text.size() <= width ? text.size() : text.rfind(' ', width);
    if (length == std::string_view::npos || length == 0) length = text.size();
    out += std::string(indent, ' ').append(text.substr(0, length)) + '\n';
    text.remove_prefix(std::min(length + 1, text.size()));
  }
}

}  // namespace drivers

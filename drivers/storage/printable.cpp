#include "drivers/storage/printable.h"

#include <algorithm>
#include <cstdint>

namespace drivers {
namespace {

// Code of the well-formed character of `n` bytes at the beginning of `text`.
std::uint32_t code_of(std::string_view text, std::size_t n) noexcept {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])); };
  if (n == 1) return byte(0);
  std::uint32_t code = byte(0) & (n == 2 ? 0x1FU : n == 3 ? 0x0FU : 0x07U);
  for (std::size_t i = 1; i < n; ++i) code = code << 6U | (byte(i) & 0x3FU);
  return code;
}

bool is_hidden(std::uint32_t code) noexcept {
  const auto between = [code](std::uint32_t low, std::uint32_t high) { return code >= low && code <= high; };
  return code < 0x20 || between(0x7F, 0x9F) || code == 0xAD || code == 0x61C || between(0x200B, 0x200F) ||
         between(0x2028, 0x202E) || between(0x2060, 0x206F) || code == 0xFEFF || between(0xFFF9, 0xFFFB) ||
         between(0xE0000, 0xE0FFF);
}

}  // namespace

// The ranges of the second byte exclude overlong forms and surrogates (Unicode 15, table 3-7).
std::size_t utf8_length(std::string_view text, std::size_t at) noexcept {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const auto between = [](unsigned value, unsigned low, unsigned high) { return value >= low && value <= high; };
  const unsigned first = byte(at);
  if (first < 0x80) return 1;
  const unsigned second = byte(at + 1);
  if (between(first, 0xC2, 0xDF)) return between(second, 0x80, 0xBF) ? 2 : 0;
  const bool third_ok = between(byte(at + 2), 0x80, 0xBF);
  if (between(first, 0xE0, 0xEF)) {
    const unsigned low = first == 0xE0 ? 0xA0 : 0x80;
    const unsigned high = first == 0xED ? 0x9F : 0xBF;
    return between(second, low, high) && third_ok ? 3 : 0;
  }
  if (between(first, 0xF0, 0xF4)) {
    const unsigned low = first == 0xF0 ? 0x90 : 0x80;
    const unsigned high = first == 0xF4 ? 0x8F : 0xBF;
    return between(second, low, high) && third_ok && between(byte(at + 3), 0x80, 0xBF) ? 4 : 0;
  }
  return 0;
}

std::size_t printable_length(std::string_view text) noexcept {
  const std::size_t n = utf8_length(text);
  return n == 0 || is_hidden(code_of(text, n)) ? 0 : n;
}

std::string printable(std::string_view text, std::size_t max_length) {
  std::string out;
  while (!text.empty()) {
    const std::size_t n = printable_length(text);
    const std::size_t n_taken = n > 0 ? n : std::max<std::size_t>(utf8_length(text), 1);
    if (out.size() + n_taken > max_length) return out + "...";
    out += n > 0 ? text.substr(0, n) : std::string_view("?");
    text.remove_prefix(n_taken);
  }
  return out;
}

std::string printable_lines(std::string_view text, std::string_view indent) {
  std::string out;
  for (;;) {
    const std::size_t end = text.find('\n');
    out += printable(text.substr(0, end), std::string_view::npos / 2);
    if (end == std::string_view::npos) return out;
    text.remove_prefix(end + 1);
    out += '\n';
    if (!text.empty()) out += indent;
  }
}

}  // namespace drivers

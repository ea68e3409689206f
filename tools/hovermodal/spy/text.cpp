#include "tools/hovermodal/spy/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace tools {
namespace {

constexpr std::array<const char*, 8> kBlocks{"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
constexpr std::array<const char*, 8> kAsciiBlocks{"_", ".", "-", ":", "=", "+", "*", "#"};

// Bytes of the well-formed, printable UTF-8 character at the beginning of `text`; 0 = none.
std::size_t character_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])); };
  const std::uint32_t first = byte(0);
  if (first >= 0x20 && first < 0x7F) return 1;
  const std::size_t n = first >= 0xC2 && first < 0xE0 ? 2U : first >= 0xE0 && first < 0xF0 ? 3U : 0U;
  if (n == 0 || text.size() < n) return 0;
  std::uint32_t code = first & (n == 2 ? 0x1FU : 0x0FU);
  for (std::size_t i = 1; i < n; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
    code = code << 6U | (byte(i) & 0x3FU);
  }
  const bool is_overlong = n == 3 && code < 0x800;
  const bool is_surrogate = code >= 0xD800 && code < 0xE000;
  // 0x2000..0x206F: includes characters that change the writing direction or have no width.
  const bool is_invisible = code < 0xA0 || (code >= 0x2000 && code < 0x2070);
  return is_overlong || is_surrogate || is_invisible ? 0 : n;
}

// Returns the number of columns written, at most `columns`.
std::size_t append_printable(std::string_view text, std::size_t columns, std::string& out) {
  std::size_t used = 0;
  for (; !text.empty() && used < columns; ++used) {
    const std::size_t n = character_bytes(text);
    out += n == 0 ? std::string_view("?") : text.substr(0, n);
    text.remove_prefix(std::max(n, std::size_t{1}));
  }
  return used;
}

const char* block(double share, Charset charset) {
  const auto& blocks = charset == Charset::kUnicode ? kBlocks : kAsciiBlocks;
  const double level = std::clamp(share * 7.0, 0.0, 7.0);
  return blocks[static_cast<std::size_t>(std::lround(level))];
}

std::size_t begin_of_last(const std::deque<float>& values, std::size_t n) {
  return values.size() > n ? values.size() - n : 0;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  static_cast<void>(append_printable(text, text.size(), out));
  return out;
}

std::vector<std::string> wrapped(std::string_view text, std::size_t columns) {
  std::vector<std::string> lines;
  std::string line;
  const std::string clean = printable(text) + ' ';
  for (std::size_t begin = 0, end = 0; (end = clean.find(' ', begin)) != clean.npos; begin = end + 1) {
    const std::string word = clean.substr(begin, end - begin);
    if (!line.empty() && line.size() + 1 + word.size() > columns) {
      lines.push_back(line);
      line = " ";  // plus one before the word
    }
    line += (line.empty() ? "" : " ") + word;
  }
  lines.push_back(line);
  return lines;
}

std::string fit(std::string_view text, std::size_t columns) {
  std::string out;
  const std::size_t used = append_printable(text, columns, out);
  out.append(columns - used, ' ');
  return out;
}

std::string number(double value, int decimals) {
  if (std::isnan(value)) return "-";
  if (std::abs(value) >= 1e6) return fmt::format("{:.3g}", value);
  return fmt::format("{:.{}f}", value, decimals);
}

std::string sparkline(const std::deque<float>& values, std::size_t columns, Charset charset) {
  const std::size_t begin = begin_of_last(values, columns);
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (std::size_t i = begin; i < values.size(); ++i) {
    const double value = static_cast<double>(values[i]);
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  std::string out;
  for (std::size_t i = begin; i < values.size(); ++i) {
    const double value = static_cast<double>(values[i]);
    out += std::isfinite(value) ? block(high > low ? (value - low) / (high - low) : 0.5, charset) : " ";
  }
  out.append(columns - (values.size() - begin), ' ');
  return out;
}

double rms(const std::deque<float>& values, std::size_t n) {
  double sum = 0.0, sum_of_squares = 0.0, count = 0.0;
  for (std::size_t i = begin_of_last(values, n); i < values.size(); ++i) {
    const double value = static_cast<double>(values[i]);
    if (!std::isfinite(value)) continue;
    sum += value;
    sum_of_squares += value * value;
    count += 1.0;
  }
  if (count < 1.0) return std::numeric_limits<double>::quiet_NaN();
  const double mean = sum / count;
  return std::sqrt(std::max(0.0, sum_of_squares / count - mean * mean));
}

std::string shape_bars(const std::vector<float>& re, const std::vector<float>& im, std::size_t columns,
                       Charset charset) {
  const std::size_t n = std::min({re.size(), im.size(), columns / 2});
  std::string out;
  for (std::size_t i = 0; i < n; ++i) {
    const double real = static_cast<double>(re[i]);
    const double imaginary = static_cast<double>(im[i]);
    const double size = std::hypot(real, imaginary);
    if (!std::isfinite(size)) {
      out += " ?";
      continue;
    }
    out += std::abs(imaginary) > std::abs(real) ? "~" : real < 0.0 ? "-" : "+";
    out += block(size, charset);
  }
  out.append(columns - 2 * n, ' ');
  return out;
}

}  // namespace tools

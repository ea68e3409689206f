#include "drivers/storage/text_file.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

namespace drivers {
namespace {

struct FileCloser {
  void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};

void require_regular_file(const std::string& path) {
  struct stat status {};
  if (path.empty() || path.find('\0') != std::string::npos) throw FileError("the file name is empty or broken");
  if (::stat(path.c_str(), &status) != 0) {
    throw FileError(fmt::format("{}: cannot be read: {}; check the path", path, std::strerror(errno)));
  }
  if (S_ISDIR(status.st_mode)) throw FileError(fmt::format("{}: is a directory; name a file in it", path));
  if (!S_ISREG(status.st_mode)) throw FileError(fmt::format("{}: is a device or pipe; name a regular file", path));
}

// Length of the UTF-8 sequence at `at`, 0 if there is none. The ranges of the second byte exclude overlong forms and
// surrogates (Unicode 15, table 3-7).
std::size_t utf8_length(std::string_view text, std::size_t at) {
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

template <class T>
std::optional<T> parse_all(std::string_view cell) noexcept {
  if (cell.size() > 1 && cell.front() == '+' && cell[1] != '-') cell.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc{} || end != cell.data() + cell.size() || cell.empty()) return std::nullopt;
  return value;
}

}  // namespace

std::string read_text_file(const std::string& path, std::size_t max_bytes) {
  require_regular_file(path);
  const std::unique_ptr<std::FILE, FileCloser> file(std::fopen(path.c_str(), "rb"));
  if (!file)
    throw FileError(fmt::format("{}: cannot be opened: {}; check its permissions", path, std::strerror(errno)));
  std::string text;
  std::array<char, 65536> block{};
  while (const std::size_t n = std::fread(block.data(), 1, block.size(), file.get())) {
    text.append(block.data(), n);
    if (text.size() > max_bytes) {
      throw FileError(fmt::format("{}: is larger than {} KiB; is this the right file?", path, max_bytes / 1024));
    }
  }
  if (std::ferror(file.get()) != 0) throw FileError(fmt::format("{}: reading failed: {}", path, std::strerror(errno)));
  return text;
}

void require_text(std::string_view text, const std::string& name) {
  std::size_t line = 1;
  for (std::size_t at = 0; at < text.size();) {
    const auto byte = static_cast<unsigned char>(text[at]);
    if ((byte < 0x20 && byte != '\n' && byte != '\r' && byte != '\t') || byte == 0x7F) {
      throw FileError(fmt::format("{}:{}: byte 0x{:02x} is no text; is this a binary file?", name, line, byte));
    }
    const std::size_t length = utf8_length(text, at);
    if (length == 0)
      throw FileError(fmt::format("{}:{}: byte 0x{:02x} is not UTF-8; save it as UTF-8", name, line, byte));
    if (byte == '\n') ++line;
    at += length;
  }
}

std::optional<double> parse_number(std::string_view cell) noexcept {
  const std::optional<double> value = parse_all<double>(cell);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<std::int64_t> parse_whole(std::string_view cell) noexcept { return parse_all<std::int64_t>(cell); }
std::optional<std::uint64_t> parse_unsigned(std::string_view cell) noexcept { return parse_all<std::uint64_t>(cell); }

std::string printable(std::string_view text, std::size_t max_length) {
  std::string out(text.substr(0, max_length));
  for (char& c : out) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  }
  if (text.size() > max_length) out += "...";
  return out;
}

}  // namespace drivers

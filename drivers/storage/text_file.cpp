#include "drivers/storage/text_file.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

#include "drivers/storage/regular_file.h"

namespace drivers {
namespace {

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
  const FileHandle file = open_regular_file(path, "name a regular file");
  const auto require_fits = [&](std::uint64_t n_bytes) {
    if (n_bytes > max_bytes)
      throw FileError(fmt::format("{}: is larger than {} KiB; is this the right file?", path, max_bytes / 1024));
  };
  const std::uint64_t stated = bytes_of(file.get());  // files of the kernel state 0
  require_fits(stated);
  std::string text;
  text.reserve(static_cast<std::size_t>(stated));
  std::array<char, 65536> block{};
  while (const std::size_t n = read_bytes(file.get(), block.data(), block.size(), path)) {
    text.append(block.data(), n);
    require_fits(text.size());
  }
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

}  // namespace drivers

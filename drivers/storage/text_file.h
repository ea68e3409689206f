#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "drivers/storage/printable.h"

namespace drivers {

// A fault in a file's content: "FILE:LINE: what; remedy".
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The whole of a regular file; refuses a missing or unreadable one, a directory, a device or pipe (which could block
// forever) and anything over `max_bytes`.
[[nodiscard]] std::string read_text_file(const std::string& path, std::size_t max_bytes);

// Throws FileError naming the line, unless `text` is UTF-8 without control characters other than tab and line ends.
void require_text(std::string_view text, const std::string& name);

// Empty unless the whole cell is one finite decimal number (no spaces, no hex). Locale-independent.
[[nodiscard]] std::optional<double> parse_number(std::string_view cell) noexcept;
[[nodiscard]] std::optional<std::int64_t> parse_whole(std::string_view cell) noexcept;
[[nodiscard]] std::optional<std::uint64_t> parse_unsigned(std::string_view cell) noexcept;

}  // namespace drivers

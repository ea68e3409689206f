#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/storage/limits.h"
#include "drivers/storage/regular_file.h"

namespace drivers {

// The lines of a CSV file, one at a time, in bounded memory.
class CsvLines {
 public:
  static constexpr std::size_t kMaxLineBytes = Limits::kLineBytes;

  explicit CsvLines(const std::string& path);

  // The next line without its end, valid until the next call; false at the end of the file.
  [[nodiscard]] bool next(std::string_view& line);
  // Of the whole file, read once more. Throws FileError.
  [[nodiscard]] std::uint64_t count_lines() const;
  // Throws FileError where the file has more lines than `most`, before memory is taken for them.
  void require_lines(std::uint64_t most, const std::string& remedy) const;
  [[noreturn]] void fail(const std::string& what) const;  // throws FileError "PATH:LINE: what"

 private:
  bool refill();

  std::string path_;
  FileHandle file_;
  std::vector<char> block_;
  std::size_t begin_ = 0, end_ = 0;  // unread part of block_
  std::size_t line_number_ = 0;
};

// Splits at commas, trims spaces; reuses `cells`. The views live as long as `line`.
void split_cells(std::string_view line, std::vector<std::string_view>& cells);

// "# key: value" -> true. Other comments give false.
[[nodiscard]] bool split_comment(std::string_view line, std::string& key, std::string& value);

// Decimal seconds to whole nanoseconds without an intermediate double: 9 decimals are exact. False = not such a
// number.
[[nodiscard]] bool parse_seconds_ns(std::string_view cell, std::int64_t& out_ns) noexcept;

}  // namespace drivers

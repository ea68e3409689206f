#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "drivers/storage/csv.h"
#include "drivers/storage/csv_lines.h"

namespace drivers {

// The memory of a table while it is read, by the bounds of limits.h.
class SeriesRoom {
 public:
  // Once the columns are known, before their first row: reserves what the lines of the file need. Throws FileError
  // where they are more than Limits::kSeriesCells values.
  void reserve(const CsvLines& lines, SeriesFile& out);
  // Before each row; for a file that grows while it is read.
  void require(const CsvLines& lines, const SeriesFile& out) const;
  // Keeps a comment of the head; all together are bounded by Limits::kCommentBytes.
  void keep_comment(const CsvLines& lines, const std::string& key, const std::string& value, SeriesFile& out);

 private:
  std::uint64_t most_rows_ = 0;
  std::size_t comment_bytes_ = 0;
};

}  // namespace drivers

#include "drivers/storage/series_room.h"

#include <fmt/format.h>

#include <vector>

#include "drivers/storage/limits.h"

namespace drivers {

void SeriesRoom::reserve(const CsvLines& lines, SeriesFile& out) {
  most_rows_ = Limits::kSeriesCells / out.columns.size();
  const std::uint64_t n_lines = lines.count_lines();
  if (n_lines > most_rows_)
    lines.fail(fmt::format("{} lines of {} columns are more than {} values; divide the record, or leave out columns",
                           n_lines, out.columns.size(), Limits::kSeriesCells));
  for (std::vector<double>& column : out.columns) column.reserve(static_cast<std::size_t>(n_lines));
}

void SeriesRoom::require(const CsvLines& lines, const SeriesFile& out) const {
  if (out.columns.front().size() >= most_rows_)
    lines.fail(fmt::format("more than {} values; read the file when nothing writes it any more", Limits::kSeriesCells));
}

void SeriesRoom::keep_comment(const CsvLines& lines, const std::string& key, const std::string& value,
                              SeriesFile& out) {
  comment_bytes_ += key.size() + value.size() + 1;
  if (comment_bytes_ > Limits::kCommentBytes)
    lines.fail(fmt::format("more than {} bytes of comments; delete them", Limits::kCommentBytes));
  out.comments[key] = value;
}

}  // namespace drivers

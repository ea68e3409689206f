#include "drivers/exchange/series_file.h"

#include <array>
#include <string_view>

#include "drivers/storage/regular_file.h"

namespace drivers {

SeriesFile read_any_series(const std::string& path, const ForeignFormat& format) {
  std::array<char, 128> head{};
  std::size_t n_bytes = 0;
  {
    const FileHandle file = open_regular_file(path, "name a table of numbers, a universal file or a MAT file");
    n_bytes = read_bytes(file.get(), head.data(), head.size(), path);
  }
  const std::string_view begin(head.data(), n_bytes);
  if (begin.starts_with("MATLAB ") || path.ends_with(".mat")) return read_mat_series(path);
  const std::size_t mark = begin.find_first_not_of(" \r\n");
  const std::size_t end = begin.find_first_of("\r\n", mark);
  if (mark != std::string_view::npos && end != std::string_view::npos) {
    std::string_view line = begin.substr(mark, end - mark);
    while (line.ends_with(' ')) line.remove_suffix(1);
    // A table of one column may begin with -1, too: the format wants four blanks before it.
    if (line == "-1" && mark >= 4 && begin.substr(mark - 4, 4) == "    ") return read_uff_series(path);
  }
  return read_foreign_series(path, format);
}

}  // namespace drivers

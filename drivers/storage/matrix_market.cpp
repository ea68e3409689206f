#include "drivers/storage/matrix_market.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "drivers/storage/ascii.h"
#include "drivers/storage/limits.h"
#include "drivers/storage/regular_file.h"
#include "drivers/storage/text_file.h"

namespace drivers {
namespace {

// The lines of a file of any size, one after the other.
class Lines {
 public:
  explicit Lines(const std::string& path)
      : path_(path), file_(open_regular_file(path, "name a MatrixMarket file (.mtx)", Limits::kMatrixBytes)) {}

  [[nodiscard]] bool next(std::string_view& line) {
    while (true) {
      const std::size_t end = buffer_.find('\n', at_);
      if (end != std::string::npos) {
        line = std::string_view(buffer_).substr(at_, end - at_);
        at_ = end + 1;
        ++number_;
        return true;
      }
      if (ended_) {
        if (at_ >= buffer_.size()) return false;
        line = std::string_view(buffer_).substr(at_);
        at_ = buffer_.size();
        ++number_;
        return true;
      }
      if (buffer_.size() - at_ > Limits::kLineBytes) refuse("a line is too long; is this a MatrixMarket file?");
      buffer_.erase(0, at_);
      at_ = 0;
      const std::size_t before = buffer_.size();
      buffer_.resize(before + kBlockBytes);
      const std::size_t read = read_bytes(file_.get(), buffer_.data() + before, kBlockBytes, path_);
      buffer_.resize(before + read);
      ended_ = read < kBlockBytes;
    }
  }
  [[noreturn]] void refuse(const std::string& what) const {
    throw FileError(fmt::format("{}:{}: {}", path_, number_, what));
  }

 private:
  static constexpr std::size_t kBlockBytes = 1U << 20U;
  const std::string& path_;
  FileHandle file_;
  std::string buffer_;
  std::size_t at_ = 0, number_ = 0;
  bool ended_ = false;
};

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> out;
  constexpr const char* kBlank = " \t\r";
  for (std::size_t at = line.find_first_not_of(kBlank); at != std::string_view::npos;
       at = line.find_first_not_of(kBlank, at)) {
    const std::size_t end = std::min(line.find_first_of(kBlank, at), line.size());
    out.push_back(line.substr(at, end - at));
    at = end;
  }
  return out;
}

struct Head {
  bool coordinate = true, symmetric = false;
};

Head head_of(Lines& lines) {
  std::string_view line;
  const auto words = lines.next(line) ? words_of(line) : std::vector<std::string_view>{};
  if (words.size() != 5 || lower_ascii(words[0]) != "%%matrixmarket" || lower_ascii(words[1]) != "matrix")
    lines.refuse("does not begin with %%MatrixMarket matrix ...; export K and M in MatrixMarket format");
  Head out;
  const std::string format = lower_ascii(words[2]), field = lower_ascii(words[3]), symmetry = lower_ascii(words[4]);
  if (format != "coordinate" && format != "array")
    lines.refuse(fmt::format("format `{}`: write coordinate or array", printable(format)));
  if (field != "real" && field != "integer" && field != "double")
    lines.refuse(fmt::format("field `{}`: a matrix of real numbers is needed", printable(field)));
  if (symmetry != "general" && symmetry != "symmetric")
    lines.refuse(fmt::format("`{}`: write general or symmetric", printable(symmetry)));
  out.coordinate = format == "coordinate", out.symmetric = symmetry == "symmetric";
  return out;
}

bool next_filled(Lines& lines, std::string_view& line) {
  while (lines.next(line)) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first != std::string_view::npos && line[first] != '%') return true;
  }
  return false;
}

std::uint64_t count(Lines& lines, std::string_view word, std::uint64_t low, std::uint64_t high, const char* what) {
  const auto value = parse_unsigned(word);
  if (!value || *value < low || *value > high)
    lines.refuse(fmt::format("{} `{}` is refused: allowed {} .. {}", what, printable(std::string(word)), low, high));
  return *value;
}

double element(Lines& lines, std::string_view word) {
  double value = 0.0;
  const auto [end, error] =
      std::from_chars(word.data() + (word.starts_with('+') ? 1 : 0), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value))
    lines.refuse(fmt::format("`{}` is no finite number", printable(std::string(word))));
  return value;
}

}  // namespace

Eigen::SparseMatrix<double> read_matrix_market(const std::string& path) {
  Lines lines(path);
  const Head head = head_of(lines);
  std::string_view line;
  const auto sizes = next_filled(lines, line) ? words_of(line) : std::vector<std::string_view>{};
  if (sizes.size() != (head.coordinate ? 3U : 2U)) lines.refuse("expected the sizes: rows columns [entries]");
  const std::uint64_t rows = count(lines, sizes[0], 1, Limits::kMatrixRows, "rows");
  const std::uint64_t columns = count(lines, sizes[1], 1, Limits::kMatrixRows, "columns");
  if (head.symmetric && rows != columns) lines.refuse("symmetric, but not square");
  const std::uint64_t dense = head.symmetric ? rows * (rows + 1) / 2 : rows * columns;
  if (!head.coordinate && dense > Limits::kMatrixEntries)
    lines.refuse(
        fmt::format("{} elements are more than {}; export in coordinate format", dense, Limits::kMatrixEntries));
  const std::uint64_t n = head.coordinate ? count(lines, sizes[2], 0, Limits::kMatrixEntries, "entries") : dense;
  std::vector<Eigen::Triplet<double, int>> entries;
  std::uint64_t row = 0, column = 0;  // of an array: the next element, down the columns
  for (std::uint64_t i = 0; i < n; ++i) {
    if (!next_filled(lines, line)) lines.refuse(fmt::format("ends after {} of {} entries; is the file whole?", i, n));
    const auto words = words_of(line);
    if (words.size() != (head.coordinate ? 3U : 1U))
      lines.refuse(head.coordinate ? "expected: row column value" : "expected: one value");
    const std::uint64_t r = head.coordinate ? count(lines, words[0], 1, rows, "row") - 1 : row;
    const std::uint64_t c = head.coordinate ? count(lines, words[1], 1, columns, "column") - 1 : column;
    const double value = element(lines, words.back());
    if (++row == rows) row = head.symmetric ? ++column : (++column, 0);
    entries.emplace_back(static_cast<int>(r), static_cast<int>(c), value);
    if (head.symmetric && r != c) entries.emplace_back(static_cast<int>(c), static_cast<int>(r), value);
  }
  if (next_filled(lines, line)) lines.refuse(fmt::format("more than the {} entries stated; is the file whole?", n));
  Eigen::SparseMatrix<double> out(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

}  // namespace drivers

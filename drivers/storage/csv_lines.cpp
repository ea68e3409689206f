#include "drivers/storage/csv_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>

#include "drivers/storage/ascii.h"
#include "drivers/storage/text_file.h"

namespace drivers {

CsvLines::CsvLines(const std::string& path)
    : path_(path), file_(open_regular_file(path, "name a CSV file")), block_(4 * kMaxLineBytes) {}

void CsvLines::fail(const std::string& what) const {
  throw FileError(fmt::format("{}:{}: {}", path_, line_number_, what));
}

std::uint64_t CsvLines::count_lines() const {
  const FileHandle file = open_regular_file(path_, "name a CSV file");
  std::vector<char> block(kMaxLineBytes);
  std::uint64_t n = 1;  // the last one may have no end
  for (std::size_t size = 0; (size = read_bytes(file.get(), block.data(), block.size(), path_)) > 0;)
    n += static_cast<std::uint64_t>(std::count(block.data(), block.data() + size, '\n'));
  return n;
}

void CsvLines::require_lines(std::uint64_t most, const std::string& remedy) const {
  if (bytes_of(file_.get()) <= most) return;
  if (const std::uint64_t n = count_lines(); n > most)
    throw FileError(fmt::format("{}: {} lines are more than {}: {}", path_, n, most, remedy));
}

bool CsvLines::refill() {
  std::memmove(block_.data(), block_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  const std::size_t n = read_bytes(file_.get(), block_.data() + end_, block_.size() - end_, path_);
  end_ += n;
  return n > 0;
}

bool CsvLines::next(std::string_view& line) {
  const auto find_end = [&](std::size_t from) {
    return std::string_view(block_.data() + from, end_ - from).find('\n');
  };
  std::size_t length = find_end(begin_);
  ++line_number_;
  while (length == std::string_view::npos) {
    const std::size_t n_seen = end_ - begin_;
    if (n_seen > kMaxLineBytes) break;
    if (!refill()) break;
    const std::size_t at = find_end(begin_ + n_seen);
    if (at != std::string_view::npos) length = n_seen + at;
  }
  const bool last_without_end = length == std::string_view::npos;
  if (last_without_end) length = end_ - begin_;
  if (last_without_end && length == 0) return false;
  if (length > kMaxLineBytes)
    fail(fmt::format("the line is longer than {} KiB; is this a CSV file?", kMaxLineBytes / 1024));
  line = std::string_view(block_.data() + begin_, length);
  begin_ += length + (last_without_end ? 0 : 1);
  if (line.find('\0') != std::string_view::npos) fail("the line holds a NUL byte; the file is binary or damaged");
  if (line.ends_with('\r')) line.remove_suffix(1);
  if (line_number_ == 1 && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
  return true;
}

void split_cells(std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  for (;;) {
    const std::size_t comma = line.find(',');
    cells.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

bool split_comment(std::string_view line, std::string& key, std::string& value) {
  if (!line.starts_with('#')) return false;
  line.remove_prefix(1);
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos) return false;
  key = trimmed(line.substr(0, colon));
  value = trimmed(line.substr(colon + 1));
  return !key.empty();
}

bool parse_seconds_ns(std::string_view cell, std::int64_t& out_ns) noexcept {
  constexpr std::int64_t kMaxSeconds = 9'000'000'000;  // fits int64 in nanoseconds
  const bool negative = cell.starts_with('-');
  if (negative) cell.remove_prefix(1);
  std::int64_t seconds = 0;
  const char* const end = cell.data() + cell.size();
  auto [at, error] = std::from_chars(cell.data(), end, seconds);
  if (error != std::errc{} || seconds < 0 || seconds > kMaxSeconds || cell.empty() || cell.front() == '-') return false;
  std::int64_t fraction_ns = 0;
  if (at != end && *at == '.') {
    std::int64_t unit_ns = 100'000'000;
    for (++at; at != end && *at >= '0' && *at <= '9'; ++at, unit_ns /= 10) fraction_ns += unit_ns * (*at - '0');
  }
  if (at != end) return false;
  out_ns = (seconds * 1'000'000'000 + fraction_ns) * (negative ? -1 : 1);
  return true;
}

}  // namespace drivers

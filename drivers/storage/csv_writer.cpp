#include "drivers/storage/csv_writer.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <utility>

#include "drivers/storage/partial_file.h"
#include "drivers/storage/regular_file.h"
#include "drivers/storage/text_file.h"

namespace drivers {
namespace {

constexpr std::array<std::int64_t, 10> kPowersOfTen{1,      10,      100,      1000,      10000,
                                                    100000, 1000000, 10000000, 100000000, 1000000000};

// `value` in units of 10^-n_decimals.
void append_scaled(fmt::memory_buffer& out, std::int64_t value, int n_decimals) {
  const std::int64_t unit = kPowersOfTen[static_cast<std::size_t>(n_decimals)];
  if (value < 0) out.push_back('-');
  // Unsigned: the magnitude of the most negative value does not fit the signed type.
  const std::uint64_t magnitude =
      value < 0 ? 0U - static_cast<std::uint64_t>(value) : static_cast<std::uint64_t>(value);
  append_text(out, fmt::format_int(magnitude / static_cast<std::uint64_t>(unit)).c_str());
  if (n_decimals == 0) return;
  std::array<char, 10> digits{};
  std::uint64_t fraction = magnitude % static_cast<std::uint64_t>(unit);
  for (int i = n_decimals - 1; i >= 0; --i, fraction /= 10) {
    digits[static_cast<std::size_t>(i)] = static_cast<char>('0' + fraction % 10);
  }
  out.push_back('.');
  out.append(digits.data(), digits.data() + n_decimals);
}

}  // namespace

CsvWriter::CsvWriter(std::string path, OldFile old) : path_(std::move(path)), partial_path_(partial_path(path_)) {
  if (old == OldFile::kRemove && ::unlink(path_.c_str()) != 0 && errno != ENOENT) {
    throw FileError(fmt::format("{}: cannot be replaced: {}; name another folder", path_, std::strerror(errno)));
  }
  descriptor_ = open_new_file(partial_path_.c_str());
  if (descriptor_ < 0) {
    throw FileError(fmt::format("{}: cannot be written: {}; check the folder and its permissions", partial_path_,
                                std::strerror(errno)));
  }
  buffer_.reserve(kBlockBytes + (1U << 16U));
}

CsvWriter::~CsvWriter() {
  flush();
  close_file();
}

void CsvWriter::close_file() noexcept {
  // Network file systems may report a full disk only here.
  if (descriptor_ >= 0 && ::close(std::exchange(descriptor_, -1)) != 0 && error_ == 0) error_ = errno;
}

bool CsvWriter::flush() noexcept {
  if (error_ == 0 && descriptor_ >= 0 && write_bytes(descriptor_, buffer_.data(), buffer_.size()) != buffer_.size())
    error_ = errno;
  buffer_.clear();
  return error_ == 0;
}

void CsvWriter::commit() {
  flush();
  if (error_ == 0 && !sync_to_disk(descriptor_)) error_ = errno;
  close_file();
  if (error_ == 0 && std::rename(partial_path_.c_str(), path_.c_str()) != 0) error_ = errno;
  if (error_ == 0) return;
  throw FileError(
      fmt::format("{}: writing failed: {}; what was written stays in {}", path_, std::strerror(error_), partial_path_));
}

bool append_fixed(fmt::memory_buffer& out, double value, int n_decimals) {
  if (!(std::abs(value) < 9e8)) return false;
  append_scaled(out, std::llround(value * static_cast<double>(kPowersOfTen[static_cast<std::size_t>(n_decimals)])),
                n_decimals);
  return true;
}

void append_seconds(fmt::memory_buffer& out, std::int64_t t_ns) { append_scaled(out, t_ns, 9); }

}  // namespace drivers

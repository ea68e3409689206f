#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace drivers {

// Handling of an older file of the same name at the start. kRemove: after a crash no file looks like this run's result.
// kKeepUntilCommit: at any moment a reader finds either the old file or the complete new one.
enum class OldFile : std::uint8_t { kRemove, kKeepUntilCommit };

// A text file written in large blocks under the name "<path>.partial" and renamed to `path` by commit(). After the
// first failed write (disk full) it accepts no more data and keeps the reason; the written part stays as *.partial.
class CsvWriter {
 public:
  // Throws FileError.
  explicit CsvWriter(std::string path, OldFile old = OldFile::kRemove);
  ~CsvWriter();
  CsvWriter(const CsvWriter&) = delete;
  CsvWriter& operator=(const CsvWriter&) = delete;

  // Append here, then call end_line().
  [[nodiscard]] fmt::memory_buffer& buffer() noexcept { return buffer_; }
  // Passes the block to the system when it is large enough. False = the file has failed, now or earlier.
  bool end_line() noexcept { return buffer_.size() < kBlockBytes ? error_ == 0 : flush(); }

  // Passes what there is to the system, which keeps it when this process is killed. False = the file has failed.
  bool flush() noexcept;

  [[nodiscard]] int error() const noexcept { return error_; }  // errno of the first failure, 0 = none
  [[nodiscard]] const std::string& path() const noexcept { return path_; }

  // Writes the rest, synchronises it to disk, renames. Throws FileError with the reason.
  void commit();

 private:
  static constexpr std::size_t kBlockBytes = 1U << 18U;
  void close_file() noexcept;

  std::string path_, partial_path_;
  fmt::memory_buffer buffer_;
  int descriptor_ = -1;
  int error_ = 0;
};

// Appends `value` with a fixed number of decimals, 0..9, rounded half away from zero. Ten times as fast as printf.
// Returns false and appends nothing if the value is not finite or its magnitude is 9e8 or more.
bool append_fixed(fmt::memory_buffer& out, double value, int n_decimals);
// Nanoseconds as seconds with 9 decimals, exactly.
void append_seconds(fmt::memory_buffer& out, std::int64_t t_ns);
inline void append_text(fmt::memory_buffer& out, std::string_view text) {
  out.append(text.data(), text.data() + text.size());
}

}  // namespace drivers

#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace drivers {

struct FileCloser {
  void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};
using FileHandle = std::unique_ptr<std::FILE, FileCloser>;

// Opens a regular file for reading. Never waits: a pipe or a device is refused, whatever its name leads to. `what` says
// what to name instead ("name a CSV file"). Throws FileError: missing, unreadable, no regular file, or larger than
// `max_bytes`, with its size.
[[nodiscard]] FileHandle open_regular_file(const std::string& path, std::string_view what,
                                           std::uint64_t max_bytes = UINT64_MAX);
// Reads up to n_bytes; fewer: the end of the file. An interrupted read is repeated. Throws FileError with `path` where
// the disk fails: half a file is never taken for a whole one.
[[nodiscard]] std::size_t read_bytes(std::FILE* file, void* to, std::size_t n_bytes, const std::string& path);
// Writes n_bytes, however the kernel divides them; fewer are written: errno says why. An interrupted write is repeated.
[[nodiscard]] std::size_t write_bytes(int descriptor, const void* from, std::size_t n_bytes) noexcept;
[[nodiscard]] std::uint64_t bytes_of(std::FILE* file) noexcept;  // its size; 0 where that is unknown

}  // namespace drivers

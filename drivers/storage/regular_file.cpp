#include "drivers/storage/regular_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "drivers/storage/text_file.h"

namespace drivers {

FileHandle open_regular_file(const std::string& path, std::string_view what, std::uint64_t max_bytes) {
  const std::string name = printable(path, 300);
  if (path.empty() || path.find('\0') != std::string::npos) throw FileError("the file name is empty or broken");
  // Without O_NONBLOCK a pipe would be waited for here.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (descriptor < 0)
    throw FileError(
        fmt::format("{}: cannot be read: {}; check the path and its permissions", name, std::strerror(errno)));
  FileHandle file(::fdopen(descriptor, "rb"));
  if (!file) {
    ::close(descriptor);
    throw FileError(fmt::format("{}: cannot be read: {}", name, std::strerror(errno)));
  }
  struct stat status {};
  if (::fstat(descriptor, &status) != 0)
    throw FileError(fmt::format("{}: cannot be read: {}", name, std::strerror(errno)));
  if (S_ISDIR(status.st_mode)) throw FileError(fmt::format("{}: is a directory; {}", name, what));
  if (!S_ISREG(status.st_mode))
    throw FileError(fmt::format("{}: is a device or pipe, no regular file; {}", name, what));
  if (static_cast<std::uint64_t>(status.st_size) > max_bytes)
    throw FileError(fmt::format("{}: has {} bytes, more than {} are refused; is this the right file?", name,
                                status.st_size, max_bytes));
  return file;
}

std::size_t read_bytes(std::FILE* file, void* to, std::size_t n_bytes, const std::string& path) {
  auto* const begin = static_cast<std::uint8_t*>(to);
  std::size_t n = 0;
  for (;;) {
    errno = 0;
    n += std::fread(begin + n, 1, n_bytes - n, file);
    if (n == n_bytes || std::ferror(file) == 0) return n;
    if (errno != EINTR)
      throw FileError(fmt::format("{}: reading failed: {}; check the disk, or copy the file again",
                                  printable(path, 300), std::strerror(errno)));
    std::clearerr(file);
  }
}

std::size_t write_bytes(int descriptor, const void* from, std::size_t n_bytes) noexcept {
  const auto* const begin = static_cast<const std::uint8_t*>(from);
  std::size_t n_written = 0;
  while (n_written < n_bytes) {
    const ssize_t n = ::write(descriptor, begin + n_written, n_bytes - n_written);
    if (n < 0 && errno == EINTR) continue;
    if (n == 0) errno = EIO;
    if (n <= 0) break;
    n_written += static_cast<std::size_t>(n);
  }
  return n_written;
}

std::uint64_t bytes_of(std::FILE* file) noexcept {
  struct stat status {};
  return ::fstat(::fileno(file), &status) == 0 && status.st_size > 0 ? static_cast<std::uint64_t>(status.st_size) : 0;
}

}  // namespace drivers

#include "drivers/storage/scratch_file.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/types.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace drivers {
namespace {

constexpr mode_t kOwnerOnly = 0600;

// For file systems without O_TMPFILE. -1: not possible.
int open_unlinked(const std::string& folder) {
  std::string path = folder + "/.hovermodal_XXXXXX";
  const int file = ::mkostemp(path.data(), O_CLOEXEC);
  if (file >= 0) (void)::unlink(path.c_str());
  return file;
}

}  // namespace

std::optional<ScratchFile> ScratchFile::in(const std::string& folder) noexcept {
  if (folder.empty()) return std::nullopt;
  try {
    int file = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, kOwnerOnly);
    if (file < 0) file = open_unlinked(folder);
    if (file >= 0) return ScratchFile(file);
  } catch (...) {  // no memory for a path
  }
  return std::nullopt;
}

ScratchFile::ScratchFile(ScratchFile&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

ScratchFile& ScratchFile::operator=(ScratchFile&& other) noexcept {
  std::swap(file_, other.file_);
  return *this;
}

ScratchFile::~ScratchFile() {
  if (file_ >= 0) (void)::close(file_);
}

bool ScratchFile::write(std::uint64_t at, std::span<const std::byte> bytes) noexcept {
  while (!bytes.empty()) {
    const ssize_t n = ::pwrite(file_, bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    at += static_cast<std::uint64_t>(n), bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return true;
}

bool ScratchFile::read(std::uint64_t at, std::span<std::byte> bytes) noexcept {
  while (!bytes.empty()) {
    const ssize_t n = ::pread(file_, bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    at += static_cast<std::uint64_t>(n), bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return true;
}

}  // namespace drivers

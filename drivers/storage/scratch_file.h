#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace drivers {

// Bytes that are too many for memory, in a file without a name: it ends with this object or its process. One thread.
class ScratchFile {
 public:
  // Empty: the folder takes no such file.
  [[nodiscard]] static std::optional<ScratchFile> in(const std::string& folder) noexcept;
  ScratchFile(ScratchFile&& other) noexcept;
  ScratchFile& operator=(ScratchFile&& other) noexcept;
  ~ScratchFile();

  // False: not, or not all of them.
  [[nodiscard]] bool write(std::uint64_t at, std::span<const std::byte> bytes) noexcept;
  [[nodiscard]] bool read(std::uint64_t at, std::span<std::byte> bytes) noexcept;

 private:
  explicit ScratchFile(int file) noexcept : file_(file) {}
  int file_;  // -1: moved from
};

}  // namespace drivers

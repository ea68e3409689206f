#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "drivers/storage/limits.h"

namespace drivers {

// A file of bytes that is whole or refused: magic, version, length, FNV-1a checksum, then the bytes. It is written
// beside its place, brought to the disk, renamed, and its folder brought to the disk too: after a loss of power the old
// file or the new one stands there, never a part of one.
inline constexpr std::uint32_t kCheckpointVersion = 3;

// Empty: written. Otherwise the reason (disk full, read-only, no such folder); the existing file is then kept.
[[nodiscard]] std::string write_checkpoint(const std::string& path, std::span<const std::uint8_t> bytes) noexcept;

struct CheckpointRead {
  bool exists = false;
  std::vector<std::uint8_t> bytes;
  std::string refused;  // why the file is not used; empty: bytes are complete, or there is no file
};
[[nodiscard]] CheckpointRead read_checkpoint(const std::string& path, std::uint64_t max_bytes = Limits::kStateBytes);

// Identity of the current boot of the kernel, within which CLOCK_MONOTONIC continues. Empty: unknown.
[[nodiscard]] std::string boot_id();

}  // namespace drivers

#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/storage/regular_file.h"

namespace drivers {

// Reads the events of an LCM event log, in order. Replaces liblcm 1.3.1, which trusts the lengths in a file: one of
// 2147483647 terminates the program. Accepts any bytes: an invalid event is left out and counted, and the next one is
// searched for. Lengths over Limits::kRecordEventBytes are invalid.
class EventLogReader {
 public:
  static constexpr std::int32_t kLongestChannel = 999;  // LCM's own limit

  struct Event {
    std::string channel;
    std::int64_t utc_us = 0;  // as written: may stay constant or decrease
    std::vector<std::uint8_t> data;
  };

  explicit EventLogReader(const std::string& path);  // throws FileError: cannot be read, not a regular file

  // False: the end; an event truncated by the end of the file is ignored. Throws FileError where the disk fails.
  [[nodiscard]] bool next(Event& out);
  [[nodiscard]] std::uint64_t n_damaged() const noexcept { return n_damaged_; }

 private:
  enum class Taken { kEvent, kDamaged, kEnd };
  [[nodiscard]] Taken take(Event& out);
  [[nodiscard]] std::optional<std::uint8_t> next_byte();
  [[nodiscard]] bool find_event();
  [[nodiscard]] bool read(void* to, std::size_t n_bytes);

  std::string path_;
  FileHandle file_;
  std::uint64_t n_damaged_ = 0;
};

}  // namespace drivers

#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace drivers {

// The events of an LCM event log, in order. In place of liblcm 1.3.1, which believes the lengths in a file: one of
// 2147483647 ends the program. Takes any bytes: an event that cannot be is left out and counted, and the next one
// looked for; memory grows with what the file holds, not with what it says. One thread.
class EventLogReader {
 public:
  static constexpr std::int32_t kLongestChannel = 999;  // LCM's own

  struct Event {
    std::string channel;
    std::int64_t utc_us = 0;  // as it was written: may stand still or go back
    std::vector<std::uint8_t> data;
  };

  explicit EventLogReader(const std::string& path);  // throws FileError: cannot be read, is no regular file

  // False: the end; an event that the file's end cuts off is none.
  [[nodiscard]] bool next(Event& out);
  [[nodiscard]] std::uint64_t n_damaged() const noexcept { return n_damaged_; }

 private:
  enum class Taken { kEvent, kDamaged, kEnd };
  [[nodiscard]] Taken take(Event& out);
  [[nodiscard]] bool find_event();
  [[nodiscard]] bool read(void* to, std::size_t n_bytes);

  struct Closer {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Closer> file_;
  std::uint64_t n_damaged_ = 0;
};

}  // namespace drivers

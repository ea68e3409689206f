#pragma once

#include <lcm/eventlog.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace drivers {

// Writer of an LCM event log, which lcm-logplayer, lcm-spy and `hovermodal spy` read.
class EventLog {
 public:
  virtual ~EventLog() = default;
  virtual bool write(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t utc_ns) noexcept = 0;
  virtual bool flush() noexcept = 0;  // what was written survives the end of this process
};

// One file, overwritten.
class EventLogFile : public EventLog {
 public:
  explicit EventLogFile(const std::string& path);  // throws std::runtime_error
  bool write(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t utc_ns) noexcept override;
  bool flush() noexcept override;
  [[nodiscard]] std::uint64_t n_bytes() const noexcept { return n_bytes_; }

 private:
  std::unique_ptr<lcm_eventlog_t, decltype(&lcm_eventlog_destroy)> log_;
  std::uint64_t n_bytes_ = 0;
};

}  // namespace drivers

#pragma once

#include <functional>
#include <memory>
#include <string>

#include "drivers/telemetry/event_log.h"
#include "drivers/telemetry/run_recorder.h"

namespace drivers {

// The event logs of one run: when one is full the next begins, starting with the run's head.
class RotatingLog : public EventLog {
 public:
  // write_head writes the beginning of each file. Nothing is opened before begin(). Throws std::runtime_error.
  explicit RotatingLog(const RecordOptions& options);

  using WriteHead = std::function<bool(EventLog& file, int file_number)>;
  void begin(WriteHead write_head);  // throws std::runtime_error

  // False: the disk is full, or the quota is reached and no earlier run can be deleted.
  bool write(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t utc_ns) noexcept override;
  bool flush() noexcept override;

  [[nodiscard]] std::string path() const { return path_of(0); }

 private:
  [[nodiscard]] std::string path_of(int file) const;
  [[nodiscard]] bool open_next();

  RecordOptions options_;
  int run_ = 1, next_file_ = 0;
  WriteHead write_head_;
  std::unique_ptr<EventLogFile> file_;  // null: before begin(), or full
};

}  // namespace drivers

#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "drivers/telemetry/disk_sync.h"
#include "drivers/telemetry/event_log.h"
#include "drivers/telemetry/run_recorder.h"

namespace drivers {

// The event logs of one run: when one is full the next begins, starting with the run's head. Used by one thread, except
// for the counts.
class RotatingLog : public EventLog {
 public:
  // write_head writes the beginning of each file. Nothing is opened before begin(). Throws std::runtime_error.
  explicit RotatingLog(const RecordOptions& options);

  using WriteHead = std::function<bool(EventLog& file, int file_number)>;
  void begin(WriteHead write_head);  // throws std::runtime_error

  // False: the disk is full, or the quota is reached and no earlier run can be deleted. It is tried again by flush().
  bool write(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t utc_ns) noexcept override;
  // What was written survives the end of this process, and within seconds a loss of power.
  bool flush() noexcept override;
  bool close() noexcept;  // the last call; false: the end of the record may not survive a loss of power

  // Any thread. Events that are in no file, and why the last one is not: errno; 0: the quota is reached.
  [[nodiscard]] std::uint64_t n_lost() const noexcept { return n_lost_.load(std::memory_order_relaxed); }
  [[nodiscard]] int error() const noexcept {
    const int error = error_.load(std::memory_order_relaxed);
    return error != 0 ? error : sync_.error();
  }
  [[nodiscard]] std::string path() const { return path_of(0); }

 private:
  [[nodiscard]] std::string path_of(int file) const;
  [[nodiscard]] bool open_next();
  void end_file() noexcept;
  void count() noexcept;

  RecordOptions options_;
  int run_ = 1, next_file_ = 0;
  WriteHead write_head_;
  std::unique_ptr<EventLogFile> file_;  // null: before begin(), or full
  DiskSync sync_;
  std::uint64_t n_lost_without_file_ = 0;
  // Relaxed: independent of other data; written by the publish stage, read by health.
  std::atomic<std::uint64_t> n_lost_{0};
  std::atomic<int> error_{0};
};

}  // namespace drivers

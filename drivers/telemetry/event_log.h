#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace drivers {

// Writer of an LCM event log, which lcm-logplayer, lcm-spy and `hovermodal spy` read.
class EventLog {
 public:
  virtual ~EventLog() = default;
  // False: an event was lost, this one or one that was waiting to be written.
  virtual bool write(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t utc_ns) noexcept = 0;
  virtual bool flush() noexcept = 0;  // what was written survives the end of this process
};

// One file, overwritten. Events are gathered and written in blocks. Where the disk fails, the events that are not in
// the file are counted, what is in it stays readable, and the following ones are tried again: space may come back. Used
// by one thread.
class EventLogFile : public EventLog {
 public:
  enum class Link { kFollow, kRefuse };
  // Throws std::runtime_error.
  explicit EventLogFile(const std::string& path, Link link = Link::kFollow);
  ~EventLogFile() override;
  EventLogFile(const EventLogFile&) = delete;
  EventLogFile& operator=(const EventLogFile&) = delete;

  bool write(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t utc_ns) noexcept override;
  bool flush() noexcept override;
  // What was written survives a loss of power; waits for the disk. False: it may not.
  bool sync() noexcept;
  // The last call, after sync(). False: what was written may not survive, or events were lost.
  bool close() noexcept;
  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }      // -1: closed
  [[nodiscard]] std::uint64_t n_bytes() const noexcept { return n_bytes_; }  // in the file and waiting
  [[nodiscard]] std::uint64_t n_lost() const noexcept { return n_lost_; }
  [[nodiscard]] int error() const noexcept { return error_; }  // errno of the last failure; 0: none

 private:
  void append(const std::string& channel, std::span<const std::uint8_t> bytes, std::int64_t utc_ns);
  void keep_whole_events(std::size_t n_written) noexcept;

  int descriptor_;
  int error_ = 0;
  std::vector<std::uint8_t> block_;
  std::vector<std::size_t> ends_;  // of the events in block_
  std::int64_t n_events_ = 0;
  std::uint64_t n_bytes_ = 0, n_kept_ = 0, n_lost_ = 0;  // n_kept_: bytes in the file
};

}  // namespace drivers

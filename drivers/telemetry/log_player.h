#pragma once

#include <cstdint>
#include <string>

#include "drivers/telemetry/event_log_reader.h"
#include "drivers/telemetry/lcm_datagrams.h"

namespace drivers {

// file://PATH?speed=S&start_timestamp=US, in LCM's URL format.
struct LogUrl {
  std::string path;
  double speed = 1.0;              // times real time; 0 = as fast as possible
  std::int64_t start_utc_us = -1;  // earlier events are left out; below 0: no limit
};

[[nodiscard]] bool is_log(const std::string& url);
// Throws std::invalid_argument naming the URL, its fault and the correct form.
[[nodiscard]] LogUrl parse_log(const std::string& url);

// Plays the messages of an LCM event log, at the pace at which they were written.
class LogPlayer {
 public:
  LogPlayer(const LogUrl& url, LcmDatagrams::Receive receive);  // throws FileError

  // Waits at most so long for a message and delivers all that are due, up to a limit. False at the end of the log.
  [[nodiscard]] bool poll(int timeout_ms);

 private:
  [[nodiscard]] std::int64_t wait_ns() const;  // until event_ is due

  LogUrl url_;
  LcmDatagrams::Receive receive_;
  EventLogReader log_;
  EventLogReader::Event event_;
  bool has_event_ = false, has_begun_ = false;
  std::int64_t first_utc_us_ = 0, began_ns_ = 0;  // of the log; CLOCK_MONOTONIC
};

}  // namespace drivers

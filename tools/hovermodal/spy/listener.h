#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "drivers/telemetry/stream_monitor.h"

namespace tools {

// Nanoseconds on the clock that a Listener gives its monitor.
[[nodiscard]] std::int64_t listener_now_ns();

// Puts what is heard on an LCM URL into a monitor.
class Listener {
 public:
  // Throws std::invalid_argument for a wrong URL or prefix, std::runtime_error when nothing can be heard there.
  Listener(const std::string& url, const std::string& prefix, drivers::StreamMonitor& monitor);
  ~Listener();

  // Waits up to 50 ms for a message and takes all that are there (within reason: the screen and signals wait
  // meanwhile). False at the end of a log.
  [[nodiscard]] bool poll();

 private:
  struct Lcm;
  std::unique_ptr<Lcm> lcm_;
};

}  // namespace tools

#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "drivers/telemetry/lcm_listener.h"
#include "drivers/telemetry/stream_monitor.h"

namespace tools {

// The clock that a Listener gives its monitor.
[[nodiscard]] inline std::int64_t listener_now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

// Puts what is heard on an LCM URL into a monitor.
class Listener : public drivers::LcmListener {
 public:
  Listener(const std::string& url, const std::string& prefix, drivers::StreamMonitor& monitor)
      : LcmListener(url, prefix, [&monitor](std::string_view channel, const void* data, std::size_t n_bytes) {
          monitor.receive(channel, data, n_bytes, listener_now_ns());
        }) {}
};

}  // namespace tools

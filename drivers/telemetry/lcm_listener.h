#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace drivers {

// Receives every message of a run (topics.h) from an LCM URL: the network, or an event log.
class LcmListener {
 public:
  // `data` is valid during the call only.
  using Receive = std::function<void(std::string_view lcm_channel, const void* data, std::size_t n_bytes)>;

  // Sends itself a message first, so that a network on which nothing can be received is reported at once. Throws
  // std::invalid_argument for a wrong URL or prefix, std::runtime_error if nothing can be received.
  LcmListener(const std::string& url, const std::string& prefix, Receive receive);
  ~LcmListener();
  LcmListener(const LcmListener&) = delete;
  LcmListener& operator=(const LcmListener&) = delete;

  // The clock for StreamMonitor::receive and for displays.
  [[nodiscard]] static std::int64_t now_ns() noexcept;

  // Waits briefly for a message and takes all that have arrived, up to a limit. False at the end of a log.
  bool poll();

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

}  // namespace drivers

#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace drivers {

// Hears every message of a run (topics.h) on an LCM URL: the network, or an event log. One thread.
class LcmListener {
 public:
  // `data` lives during the call.
  using Receive = std::function<void(std::string_view lcm_channel, const void* data, std::size_t n_bytes)>;

  // Sends itself a message first, so that a network on which nothing can be heard is told at once. Throws
  // std::invalid_argument for a wrong URL or prefix, std::runtime_error when nothing can be heard.
  LcmListener(const std::string& url, const std::string& prefix, Receive receive);
  ~LcmListener();
  LcmListener(const LcmListener&) = delete;
  LcmListener& operator=(const LcmListener&) = delete;

  // The clock for StreamMonitor::receive and what shows it.
  [[nodiscard]] static std::int64_t now_ns() noexcept;

  // Waits a little for a message and takes all that are there, within reason. False at the end of a log.
  bool poll();

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

}  // namespace drivers

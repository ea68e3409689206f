#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/telemetry/stream_monitor.h"
#include "tools/hovermodal/ground/snapshot_json.h"

namespace tools {

// The stream shown by the page: received in one thread, read in another. It follows the first stream that it receives;
// when that has been silent for some seconds and another is received, it follows the other. A service that starts again
// under the same name is a new run.
class LiveStream {
 public:
  static constexpr std::int64_t kSilence_ns = 10'000'000'000;
  static constexpr std::int64_t kLinkPeriod_ns = 1'000'000'000;  // updates are sent at least this often

  explicit LiveStream(std::string prefix);

  void receive(std::string_view lcm_channel, const void* data, std::size_t n_bytes, std::int64_t now_ns) noexcept;

  [[nodiscard]] std::string snapshot(std::int64_t now_ns) const;  // JSON, complete
  // JSON of everything received since the last call; empty: nothing. For one caller, which serves all listeners.
  [[nodiscard]] std::optional<std::string> news(std::int64_t now_ns);
  [[nodiscard]] std::string preview_jpeg() const;  // empty: none

 private:
  [[nodiscard]] LiveView view(std::int64_t now_ns) const;

  mutable std::mutex mutex_;
  std::string prefix_;
  std::unique_ptr<drivers::StreamMonitor> monitor_;
  std::int64_t boot_;
  std::int64_t run_ = 0;               // counts streams and restarts
  std::int64_t run_since_utc_ns_ = 0;  // the sender's clock
  std::uint64_t n_restarts_ = 0, n_foreign_ = 0;
  Shown shown_;
  std::int64_t told_ns_ = 0;
};

}  // namespace tools

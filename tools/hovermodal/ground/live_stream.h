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

// The stream that the page shows: heard in one thread, asked for in another. It follows the first stream it hears; when
// that one has been silent for some seconds and another is heard, it follows that one. A service that starts again
// under the same name is a new run.
class LiveStream {
 public:
  static constexpr std::int64_t kSilence_ns = 10'000'000'000;
  static constexpr std::int64_t kLinkPeriod_ns = 1'000'000'000;  // news come at least so often

  explicit LiveStream(std::string prefix);

  void receive(std::string_view lcm_channel, const void* data, std::size_t n_bytes, std::int64_t now_ns) noexcept;

  [[nodiscard]] std::string snapshot(std::int64_t now_ns) const;  // JSON, all of it
  // JSON of what has come since the last call; empty: nothing. For one caller, who tells all listeners.
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

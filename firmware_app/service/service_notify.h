#pragma once

#include <cstdint>
#include <string>

namespace app {

// Notifies the service manager (systemd, Type=notify): ready, a status line, still alive, stopping. The watchdog is
// fed only while all stages run, so that a hung stage causes a restart. Without a service manager (NOTIFY_SOCKET
// unset), or built without libsystemd, nothing is sent. Main thread.
class ServiceNotify {
 public:
  ServiceNotify();

  void ready(const std::string& status) const;
  // Call it often. `stall`: Pipeline::stall(). Feeds the watchdog every quarter of its period (WatchdogSec).
  void tick(const std::string& stall);
  void stopping() const;

  [[nodiscard]] std::int64_t feed_period_ns() const noexcept { return feed_period_ns_; }  // 0 = no watchdog requested

 private:
  std::int64_t feed_period_ns_ = 0;
  std::int64_t next_feed_ns_ = 0;
  bool stall_told_ = false;
};

}  // namespace app

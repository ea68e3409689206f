#include "firmware_app/service/service_notify.h"

#include "rt/clock.h"

#ifdef HOVERMODAL_WITH_SYSTEMD
#include <systemd/sd-daemon.h>
#endif

namespace app {

namespace {

#ifdef HOVERMODAL_WITH_SYSTEMD
void tell(const std::string& state) { (void)sd_notify(0, state.c_str()); }
std::int64_t watchdog_ns() {
  std::uint64_t period_us = 0;
  return sd_watchdog_enabled(0, &period_us) > 0 ? static_cast<std::int64_t>(period_us) * 1000 : 0;
}
#else
void tell(const std::string&) {}
std::int64_t watchdog_ns() { return 0; }
#endif

}  // namespace

ServiceNotify::ServiceNotify() : feed_period_ns_(watchdog_ns() / 4) {}

void ServiceNotify::ready(const std::string& status) const { tell("READY=1\nSTATUS=" + status); }

void ServiceNotify::tick(const std::string& stall) {
  if (!stall.empty()) {
    if (!stall_told_) tell("STATUS=stalled: " + stall);
    stall_told_ = true;
    return;
  }
  if (stall_told_) tell("STATUS=running again after a stall");
  stall_told_ = false;
  const std::int64_t now_ns = rt::monotonic_ns();
  if (feed_period_ns_ == 0 || now_ns < next_feed_ns_) return;
  next_feed_ns_ = now_ns + feed_period_ns_;
  tell("WATCHDOG=1");
}

void ServiceNotify::stopping() const { tell("STOPPING=1"); }

}  // namespace app

#include "drivers/camera/network/sender_clock.h"

#include <algorithm>
#include <cstdlib>

namespace drivers {
namespace {

constexpr std::int64_t kSettle_ns = 1'000'000'000;
constexpr std::int64_t kJump_ns = 5'000'000'000;

}  // namespace

std::optional<std::int64_t> SenderClock::to_monotonic_ns(std::optional<std::int64_t> sent_ns,
                                                         std::int64_t arrived_ns) noexcept {
  if (!sent_ns) return arrived_ns;
  const Pair now{*sent_ns, arrived_ns};
  if (last_) {
    const std::int64_t sent = now.sent_ns - last_->sent_ns, arrived = now.arrived_ns - last_->arrived_ns;
    if (sent <= 0 || std::abs(sent - arrived) > kJump_ns) forget();
  }
  const std::int64_t delay_ns = now.arrived_ns - now.sent_ns;
  if (!first_) first_ = now, least_ns_ = delay_ns;
  last_ = now;
  const bool settles = now.arrived_ns - first_->arrived_ns < kSettle_ns;
  if (settles) least_ns_ = std::min(least_ns_, delay_ns);
  return settles ? std::nullopt : std::optional(now.sent_ns + least_ns_);
}

}  // namespace drivers

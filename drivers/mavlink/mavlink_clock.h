#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace drivers {

// The autopilot's clock against this computer's CLOCK_MONOTONIC, from exchanges of TIMESYNC. An exchange states the
// remote time between sending and receiving here; its error is half the difference of the two delays, so that those
// with the shortest round trips are the most exact. The quarter with the shortest round trips of the last kKept
// exchanges is fitted by offset and drift (Mills 1991, the clock filter of NTP). After a jump of the offset the fit
// starts again: the autopilot has been restarted. One thread; without allocation.
class MavlinkClock {
 public:
  static constexpr std::size_t kKept = 512, kLeast = 8;

  struct Fit {
    double offset_ns = 0.0;  // remote less local time, at local_ns
    double drift = 0.0;      // change of the offset per local time
    double sigma_ns =
        0.0;  // of the offset: scatter of the fitted exchanges, and no less than a hundredth of the round trip
    std::int64_t local_ns = 0;
    std::int64_t round_trip_ns = 0;  // the shortest
  };

  // sent, received: here; remote: the time in the answer. False: not usable (received before it was sent, or a round
  // trip of more than a second).
  bool add(std::int64_t sent_ns, std::int64_t remote_ns, std::int64_t received_ns) noexcept;
  [[nodiscard]] std::optional<Fit> fit() const noexcept;  // empty before kLeast exchanges
  // The local time of a remote one; empty as fit().
  [[nodiscard]] std::optional<std::int64_t> local_ns(double remote_s) const noexcept;
  [[nodiscard]] std::uint64_t restarts() const noexcept { return restarts_; }

 private:
  struct Exchange {
    std::int64_t middle_ns = 0, offset_ns = 0, round_trip_ns = 0;
  };
  std::array<Exchange, kKept> exchanges_{};
  std::size_t n_ = 0, next_ = 0;
  std::optional<Fit> fit_;
  std::uint64_t restarts_ = 0;
  void update() noexcept;
};

}  // namespace drivers

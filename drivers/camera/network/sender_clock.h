#pragma once

#include <cstdint>
#include <optional>

namespace drivers {

// Puts the times of a sender on this computer's CLOCK_MONOTONIC. Intervals are the sender's; the offset is that of the
// picture that took the least time to arrive in the first second of a connection, and stays. What remains unknown is
// the delay of that picture, which is constant, and the drift of the sender's clock.
class SenderClock {
 public:
  // Empty: within the first second, or after the sender's time has jumped by more than 5 s or backwards, which
  // starts such a second again. `sent_ns` empty: the sender states no times, and arrivals are used.
  [[nodiscard]] std::optional<std::int64_t> to_monotonic_ns(std::optional<std::int64_t> sent_ns,
                                                            std::int64_t arrived_ns) noexcept;
  void forget() noexcept { *this = {}; }  // a new connection

 private:
  struct Pair {
    std::int64_t sent_ns, arrived_ns;
  };
  std::optional<Pair> first_, last_;
  std::int64_t least_ns_ = 0;  // arrived - sent
};

}  // namespace drivers

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "drivers/telemetry/topics.h"

namespace drivers {

// Bytes of a message on the link, with LCM's and IP's headers of every fragment. `channel_bytes`: its name.
[[nodiscard]] std::size_t wire_bytes(std::size_t channel_bytes, std::size_t payload_bytes) noexcept;

// Decides which messages are sent over a link of so many kbit/s: a token bucket of half a second. Estimates, health and
// residual diagnosis reports are always sent, and their bytes are charged afterwards. Displacements, spectra, tracks
// and preview images share the remainder, 10 : 6 : 4 : 5, each from its own bucket, so that none displaces the others;
// what one does not use is available to all. A message larger than a bucket is sent when its bucket is full. In the
// sender's time: no result depends on it.
class SendBudget {
 public:
  static constexpr double kHolds_s = 0.5;

  explicit SendBudget(double max_kbit_s) noexcept;  // 0 = no limit

  // False: withhold it. `now_ns` on any monotonic clock; a clock that stands still adds nothing.
  [[nodiscard]] bool admit(Topic topic, std::size_t n_bytes, std::int64_t now_ns) noexcept;

 private:
  struct Bucket {
    double share = 0.0;  // of what the always-sent messages leave
    double bytes = 0.0;  // below 0: owed
  };
  void fill(std::int64_t now_ns) noexcept;
  void pour(double bytes) noexcept;

  double bytes_per_s_;
  std::array<Bucket, kTopics> buckets_{};
  double owed_ = 0.0;  // by always-sent messages
  std::int64_t filled_ns_ = 0;
  bool is_begun_ = false;
};

}  // namespace drivers

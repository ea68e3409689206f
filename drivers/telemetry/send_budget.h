#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "drivers/telemetry/topics.h"

namespace drivers {

// Bytes that a message takes on the link: LCM's and IP's heads with every fragment. `channel_bytes`: its name.
[[nodiscard]] std::size_t wire_bytes(std::size_t channel_bytes, std::size_t payload_bytes) noexcept;

// Which messages may go over a link of so many kbit/s: a token bucket that holds half a second of it. Estimates, health
// and reports of closing the loop always go, and are paid for later. Displacements, spectra, tracks and pictures
// share what is left, 10 : 6 : 4 : 5, each from a bucket of its own, so that none crowds the others out; what one of
// them does not use overflows to all. A message larger than a bucket goes when its bucket is full. In the sender's
// time: what is sent enters no result. One thread.
class SendBudget {
 public:
  static constexpr double kHolds_s = 0.5;

  explicit SendBudget(double max_kbit_s) noexcept;  // 0 = no limit

  // False: hold it back. `now_ns` on any monotonic clock; a clock that stands still fills nothing.
  [[nodiscard]] bool admit(Topic topic, std::size_t n_bytes, std::int64_t now_ns) noexcept;

 private:
  struct Bucket {
    double share = 0.0;  // of what is left by the messages that always go
    double bytes = 0.0;  // below 0: owed
  };
  void fill(std::int64_t now_ns) noexcept;
  void pour(double bytes) noexcept;

  double bytes_per_s_;
  std::array<Bucket, kTopics> buckets_{};
  double owed_ = 0.0;  // by messages that always go
  std::int64_t filled_ns_ = 0;
  bool is_begun_ = false;
};

}  // namespace drivers

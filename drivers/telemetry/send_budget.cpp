#include "drivers/telemetry/send_budget.h"

#include <algorithm>

namespace drivers {
namespace {

constexpr double kBytesPerKbit = 125.0;
constexpr std::size_t kFragmentBytes = 1400;         // payload of a datagram of LCM 1.3
constexpr std::size_t kSentHeadBytes = 20 + 8 + 20;  // IP, UDP, LCM's head of a fragment
constexpr double kMostOwed_s = 5.0;  // of the link: limits how long a burst of estimates silences the rest

}  // namespace

std::size_t wire_bytes(std::size_t channel_bytes, std::size_t payload_bytes) noexcept {
  const std::size_t n_fragments = std::max<std::size_t>(1, (payload_bytes + kFragmentBytes - 1) / kFragmentBytes);
  return payload_bytes + channel_bytes + 1 + n_fragments * kSentHeadBytes;
}

SendBudget::SendBudget(double max_kbit_s) noexcept : bytes_per_s_(max_kbit_s * kBytesPerKbit) {
  buckets_[kDisplacement].share = 0.4;
  buckets_[kSpectrum].share = 0.24;
  buckets_[kTracks].share = 0.16;
  buckets_[kPreview].share = 0.2;
  for (Bucket& bucket : buckets_) bucket.bytes = bucket.share * bytes_per_s_ * kHolds_s;
}

void SendBudget::pour(double bytes) noexcept {
  const double holds = bytes_per_s_ * kHolds_s;
  double over = 0.0;
  for (Bucket& bucket : buckets_) {
    bucket.bytes += bucket.share * bytes;
    over += std::max(0.0, bucket.bytes - bucket.share * holds);
    bucket.bytes = std::min(bucket.bytes, bucket.share * holds);
  }
  for (Bucket& bucket : buckets_) {
    const double taken = std::min(over, bucket.share * holds - bucket.bytes);
    bucket.bytes += taken;
    over -= taken;
  }
}

void SendBudget::fill(std::int64_t now_ns) noexcept {
  const double seconds = is_begun_ ? std::max(0.0, static_cast<double>(now_ns - filled_ns_) * 1e-9) : 0.0;
  is_begun_ = true;
  filled_ns_ = now_ns;
  const double bytes = bytes_per_s_ * std::min(seconds, kMostOwed_s + kHolds_s);
  const double paid = std::min(owed_, bytes);
  owed_ -= paid;
  pour(bytes - paid);
}

bool SendBudget::admit(Topic topic, std::size_t n_bytes, std::int64_t now_ns) noexcept {
  if (!(bytes_per_s_ > 0.0)) return true;
  fill(now_ns);
  const double bytes = static_cast<double>(n_bytes);
  Bucket& bucket = buckets_[topic];
  if (!(bucket.share > 0.0)) {
    owed_ = std::min(owed_ + bytes, kMostOwed_s * bytes_per_s_);
    return true;
  }
  constexpr double kNothing = 1e-6;  // of a byte: rounding
  if (bucket.bytes + kNothing < std::min(bytes, bucket.share * bytes_per_s_ * kHolds_s)) return false;
  bucket.bytes -= bytes;
  return true;
}

}  // namespace drivers

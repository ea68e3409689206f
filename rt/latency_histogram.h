#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace rt {

// Distribution of durations in fixed memory: 16 linear buckets per octave, 1 ns to 2^40 ns (18 minutes), so that a
// percentile is at most 1/16 too long and never too short; longer ones share the last bucket, the largest is exact.
// One thread adds, any reads: relaxed, because the counts order no other data. A reader may miss a value that is being
// added at the same time. No allocation, no lock.
class LatencyHistogram {
 public:
  struct Percentiles {
    std::uint64_t n = 0;
    std::uint64_t p50_ns = 0, p99_ns = 0, p999_ns = 0, max_ns = 0;  // 0 where n is 0
  };

  // Negative durations (a stamp from the future) count as 0.
  void add(std::int64_t duration_ns) noexcept {
    const auto ns = static_cast<std::uint64_t>(std::max<std::int64_t>(duration_ns, 0));
    std::atomic<std::uint64_t>& count = counts_[bucket(ns)];
    count.store(count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);  // only the adding thread writes
    if (ns > max_ns_.load(std::memory_order_relaxed)) max_ns_.store(ns, std::memory_order_relaxed);
  }

  [[nodiscard]] Percentiles percentiles() const noexcept {
    std::array<std::uint64_t, kBuckets> counts{};
    Percentiles out;
    for (std::size_t b = 0; b < kBuckets; ++b) out.n += counts[b] = counts_[b].load(std::memory_order_relaxed);
    out.max_ns = max_ns_.load(std::memory_order_relaxed);
    out.p50_ns = percentile(counts, out, 0.5);
    out.p99_ns = percentile(counts, out, 0.99);
    out.p999_ns = percentile(counts, out, 0.999);
    return out;
  }

 private:
  static constexpr unsigned kSubBits = 4, kOctaves = 40;
  static constexpr std::uint64_t kSub = 1U << kSubBits;
  static constexpr std::size_t kBuckets = (kOctaves - kSubBits + 1) * kSub;

  // Below 16 ns a bucket is one nanosecond; above, the four bits after the leading one select it within the octave.
  [[nodiscard]] static std::size_t bucket(std::uint64_t ns) noexcept {
    if (ns < kSub) return static_cast<std::size_t>(ns);
    const auto shift = static_cast<unsigned>(std::bit_width(ns)) - 1 - kSubBits;
    const std::size_t b = (shift + 1) * kSub + static_cast<std::size_t>((ns >> shift) - kSub);
    return std::min(b, kBuckets - 1);
  }
  // The longest duration that falls into a bucket.
  [[nodiscard]] static std::uint64_t upper_ns(std::size_t b) noexcept {
    if (b < kSub) return b;
    const auto shift = static_cast<unsigned>(b / kSub - 1);
    return ((kSub + b % kSub + 1) << shift) - 1;
  }
  // The smallest duration that is not exceeded by at least `share` of all durations.
  [[nodiscard]] static std::uint64_t percentile(const std::array<std::uint64_t, kBuckets>& counts,
                                                const Percentiles& all, double share) noexcept {
    const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(all.n)));
    std::uint64_t seen = 0;
    for (std::size_t b = 0; b + 1 < kBuckets; ++b) {
      seen += counts[b];
      if (seen >= wanted && seen > 0) return std::min(upper_ns(b), all.max_ns);
    }
    return all.max_ns;
  }

  std::array<std::atomic<std::uint64_t>, kBuckets> counts_{};
  std::atomic<std::uint64_t> max_ns_{0};
};

}  // namespace rt

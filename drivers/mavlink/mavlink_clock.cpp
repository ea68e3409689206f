#include "drivers/mavlink/mavlink_clock.h"

#include <algorithm>
#include <cmath>

namespace drivers {
namespace {

constexpr std::int64_t kLongest_ns = 1'000'000'000;
constexpr std::int64_t kLatest_ns = std::int64_t{1} << 61;  // 73 years
constexpr double kJump_ns = 2e8;                            // beyond half the longest round trip that links have
constexpr double kLeastSpan_ns = 2e10;                      // of the exchanges, for a drift
constexpr double kOfRoundTrip = 0.01;                       // least sigma: delays that always differ are not seen

}  // namespace

bool MavlinkClock::add(std::int64_t sent_ns, std::int64_t remote_ns, std::int64_t received_ns) noexcept {
  if (sent_ns < 0 || received_ns < sent_ns || remote_ns < 0 || remote_ns > kLatest_ns) return false;
  const std::int64_t round_trip = received_ns - sent_ns;
  if (round_trip > kLongest_ns) return false;
  const Exchange one{sent_ns + round_trip / 2, remote_ns - (sent_ns + round_trip / 2), round_trip};
  if (fit_) {
    const double expected = fit_->offset_ns + fit_->drift * static_cast<double>(one.middle_ns - fit_->local_ns);
    if (std::abs(static_cast<double>(one.offset_ns) - expected) > kJump_ns + static_cast<double>(round_trip)) {
      n_ = next_ = 0;
      fit_.reset();
      ++restarts_;
    }
  }
  exchanges_[next_] = one;
  next_ = (next_ + 1) % kKept;
  n_ = std::min(n_ + 1, kKept);
  update();
  return true;
}

std::optional<MavlinkClock::Fit> MavlinkClock::fit() const noexcept { return fit_; }

std::optional<std::int64_t> MavlinkClock::local_ns(double remote_s) const noexcept {
  if (!fit_) return std::nullopt;
  // remote = local + offset + drift (local - local_ns)
  const double since = 1e9 * remote_s - static_cast<double>(fit_->local_ns) - fit_->offset_ns;
  return fit_->local_ns + std::llround(since / (1.0 + fit_->drift));
}

void MavlinkClock::update() noexcept {
  if (n_ < kLeast) return;
  std::array<Exchange, kKept> best = exchanges_;
  const std::size_t n = std::max(kLeast, n_ / 4);
  std::nth_element(best.begin(), best.begin() + static_cast<std::ptrdiff_t>(n - 1),
                   best.begin() + static_cast<std::ptrdiff_t>(n_),
                   [](const Exchange& a, const Exchange& b) { return a.round_trip_ns < b.round_trip_ns; });
  const auto at = best.begin();
  const auto end = at + static_cast<std::ptrdiff_t>(n);
  std::int64_t newest = at->middle_ns, oldest = newest, shortest = at->round_trip_ns;
  for (auto one = at; one != end; ++one) {
    newest = std::max(newest, one->middle_ns), oldest = std::min(oldest, one->middle_ns);
    shortest = std::min(shortest, one->round_trip_ns);
  }
  // About the newest exchange and the first one's offset, so that no digits are lost.
  const std::int64_t base = at->offset_ns;
  double t = 0.0, y = 0.0, tt = 0.0, ty = 0.0;
  const auto count = static_cast<double>(n);
  for (auto one = at; one != end; ++one) {
    const auto x = static_cast<double>(one->middle_ns - newest), value = static_cast<double>(one->offset_ns - base);
    t += x, y += value, tt += x * x, ty += x * value;
  }
  const double spread = tt - t * t / count;
  const bool has_drift = static_cast<double>(newest - oldest) > kLeastSpan_ns && spread > 0.0;
  const double drift = has_drift ? (ty - t * y / count) / spread : 0.0;
  const double here = (y - drift * t) / count;  // at the newest
  double squares = 0.0;
  for (auto one = at; one != end; ++one) {
    const double left =
        static_cast<double>(one->offset_ns - base) - here - drift * static_cast<double>(one->middle_ns - newest);
    squares += left * left;
  }
  const double scatter = std::sqrt(squares / std::max(count - (has_drift ? 2.0 : 1.0), 1.0));
  const double lever = has_drift ? std::sqrt(1.0 / count + t * t / (count * count) / spread) : std::sqrt(1.0 / count);
  Fit out;
  out.offset_ns = static_cast<double>(base) + here;
  out.drift = drift;
  out.sigma_ns = std::max(scatter * lever, kOfRoundTrip * static_cast<double>(shortest));
  out.local_ns = newest;
  out.round_trip_ns = shortest;
  fit_ = out;
}

}  // namespace drivers

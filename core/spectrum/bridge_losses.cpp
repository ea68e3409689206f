#include "core/spectrum/bridge_losses.h"

#include <algorithm>

namespace core {

namespace {

// The nearest seen samples on both sides of `at`, itself left out; false where they are too far apart.
struct Neighbours {
  std::size_t before = 0, after = 0;

  bool find(std::span<const std::uint8_t> seen, std::size_t at) noexcept {
    constexpr std::size_t kReach = kLongestBridge + 1;
    const std::size_t lowest = at >= kReach ? at - kReach : 0, highest = std::min(seen.size() - 1, at + kReach);
    for (before = at; before > lowest && (before == at || seen[before] == 0);) --before;
    for (after = at; after < highest && (after == at || seen[after] == 0);) ++after;
    // Without the sample itself a gap is one longer.
    return before < at && after > at && seen[before] != 0 && seen[after] != 0 && after - before <= kReach;
  }
  [[nodiscard]] double line(std::span<const double> x, std::size_t at) const noexcept {
    const double share = static_cast<double>(at - before) / static_cast<double>(after - before);
    return (1.0 - share) * x[before] + share * x[after];
  }
};

}  // namespace

void bridge_losses(std::span<const double> x, std::span<const std::uint8_t> seen, std::span<double> y,
                   std::span<std::uint8_t> held) noexcept {
  std::copy(x.begin(), x.end(), y.begin());
  std::copy(seen.begin(), seen.end(), held.begin());
  if (std::all_of(seen.begin(), seen.end(), [](std::uint8_t s) { return s != 0; })) return;
  Neighbours neighbours;
  std::size_t n_lost = 0, n_kept = 0;
  for (std::size_t t = 0; t < x.size(); ++t) {
    if (neighbours.find(seen, t)) ++(seen[t] != 0 ? n_kept : n_lost);
  }
  if (n_lost == 0 || n_kept == 0) return;
  const double gain = static_cast<double>(n_lost + n_kept) / static_cast<double>(n_kept);  // 1 / (1 - p)
  for (std::size_t t = 0; t < x.size(); ++t) {
    if (!neighbours.find(seen, t)) continue;
    const double line = neighbours.line(x, t);
    y[t] = seen[t] != 0 ? line + gain * (x[t] - line) : line;
    held[t] = 1;
  }
}

}  // namespace core

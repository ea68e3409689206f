#include "firmware_app/service/stages/thinning.h"

#include <algorithm>
#include <cmath>

namespace app {

namespace {
constexpr double kWindow_s = 2.0, kHeavyShare = 0.1, kSpareShare = 0.1;
constexpr std::uint64_t kLeastWindow = 16;
constexpr std::uint32_t kMostStride = 64;
}  // namespace

void OverloadWatch::begin(std::uint32_t stride) noexcept {
  stride_ = stride;
  window_ = std::max(kLeastWindow, static_cast<std::uint64_t>(std::llround(kWindow_s * rate_hz_ / stride)));
  n_ = n_dropped_ = n_dropped_before_ = 0;
  heavy_before_ = false;
}

std::uint32_t OverloadWatch::add(bool dropped) noexcept {
  n_dropped_ += dropped ? 1U : 0U;
  if (++n_ < window_) return 0;
  const bool heavy = static_cast<double>(n_dropped_) > kHeavyShare * static_cast<double>(window_);
  if (!heavy || !heavy_before_) {
    n_dropped_before_ = n_dropped_;
    heavy_before_ = heavy;
    n_ = n_dropped_ = 0;
    return 0;
  }
  const std::uint64_t n_kept = 2 * window_ - n_dropped_ - n_dropped_before_;
  const double needed = stride_ * 2.0 * static_cast<double>(window_) /
                        (static_cast<double>(std::max<std::uint64_t>(n_kept, 1)) * (1.0 - kSpareShare));
  const auto stride = static_cast<std::uint32_t>(std::clamp(std::ceil(needed), 1.0 * stride_, 1.0 * kMostStride));
  const bool is_new = stride > stride_;
  begin(stride);
  return is_new ? stride : 0;
}

}  // namespace app

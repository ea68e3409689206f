#include "core/identification/frequency_trend.h"

#include <algorithm>
#include <cmath>

namespace core {

void FrequencyTrend::add(double frequency_hz, double record_s) noexcept {
  if (!std::isfinite(frequency_hz) || !std::isfinite(record_s) || record_s <= last_s_) return;
  if (n_ == 0) first_hz_ = frequency_hz;
  const double value = frequency_hz - first_hz_;
  const double weight = record_s - last_s_;
  const double t = 0.5 * (record_s + last_s_);
  const double d = (record_s * value - last_s_ * (last_hz_ - (n_ == 0 ? 0.0 : first_hz_))) / weight;
  w_ += weight;
  wt_ += weight * t;
  wd_ += weight * d;
  wtt_ += weight * t * t;
  wtd_ += weight * t * d;
  wdd_ += weight * d * d;
  last_hz_ = frequency_hz;
  last_s_ = record_s;
  ++n_;
}

std::optional<FrequencyTrend::Slope> FrequencyTrend::slope(double variance_time) const noexcept {
  if (n_ < 3) return std::nullopt;
  const double tt = wtt_ - wt_ * wt_ / w_;
  const double td = wtd_ - wt_ * wd_ / w_;
  const double dd = wdd_ - wd_ * wd_ / w_;
  const double residual = std::max(0.0, dd - td * td / tt) / static_cast<double>(n_ - 2);
  const Slope out{td / tt, std::sqrt(std::max(variance_time, residual) / tt)};
  if (!(tt > 0.0) || !std::isfinite(out.hz_per_s) || !std::isfinite(out.std_hz_per_s)) return std::nullopt;
  return out;
}

}  // namespace core

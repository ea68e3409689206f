#include "core/compare/band_limited.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <stdexcept>

#include "core/spectrum/real_fft.h"
#include "core/types/constants.h"

namespace core {
namespace {

constexpr std::size_t kLeastBandSamples = 16;
constexpr double kOutputPerPeriod = 20.0;  // samples in a period of the upper limit, for the interpolation

// Straight lines across missing samples, constants at the ends; the mean line is removed.
std::vector<double> bridged_and_level(std::span<const double> samples) {
  std::vector<double> out(samples.begin(), samples.end());
  std::size_t last = out.size();
  for (std::size_t k = 0; k < out.size(); ++k) {
    if (!std::isfinite(out[k])) continue;
    const std::size_t from = last == out.size() ? 0 : last + 1;
    for (std::size_t i = from; i < k; ++i) {
      const double share = last == out.size() ? 1.0 : static_cast<double>(i - last) / static_cast<double>(k - last);
      out[i] = (last == out.size() ? 0.0 : (1.0 - share) * out[last]) + share * out[k];
    }
    last = k;
  }
  for (std::size_t i = last + 1; i < out.size(); ++i) out[i] = out[last];
  const auto n = static_cast<double>(out.size());
  double sum = 0.0, moment = 0.0;
  for (std::size_t k = 0; k < out.size(); ++k) {
    sum += out[k];
    moment += out[k] * (static_cast<double>(k) - (n - 1.0) / 2.0);
  }
  const double slope = 12.0 * moment / (n * (n * n - 1.0));
  for (std::size_t k = 0; k < out.size(); ++k) out[k] -= sum / n + slope * (static_cast<double>(k) - (n - 1.0) / 2.0);
  return out;
}

// 1 within the band, 0 outside, a quarter of a sine over `edge` about each limit: white noise passes as through a band
// with sharp limits.
double pass(double f_hz, const Band& band, double edge_hz) {
  const auto step = [&](double beyond_hz) {
    const double x = std::clamp(beyond_hz / edge_hz + 0.5, 0.0, 1.0);
    return std::sin(0.5 * kPi * x);
  };
  return (band.low_hz > 0.0 ? step(f_hz - band.low_hz) : 1.0) * step(band.high_hz - f_hz);
}

}  // namespace

double BandLimited::edge_hz(const Band& band, double duration_s) noexcept {
  const double edge = std::max(0.05 * band.width_hz(), 2.0 / duration_s);
  return band.low_hz > 0.0 ? std::min(edge, 1.6 * band.low_hz) : edge;
}

BandLimited::BandLimited(std::span<const double> samples, double rate_hz, const Band& band, int n_integrations)
    : rate_hz_(rate_hz), duration_s_(static_cast<double>(samples.size()) / rate_hz) {
  const bool any = std::any_of(samples.begin(), samples.end(), [](double x) { return std::isfinite(x); });
  if (samples.size() < kLeastBandSamples || !any) throw std::invalid_argument("a record of fewer than 16 samples");
  const bool is_low_pass = band.low_hz == 0.0 && n_integrations == 0;
  if (!((band.low_hz > 0.0 || is_low_pass) && band.high_hz > band.low_hz && band.high_hz < rate_hz / 2.0))
    throw std::invalid_argument("a band that is not between 0 and half the rate");
  n_missing_.assign(samples.size() + 1, 0);
  for (std::size_t k = 0; k < samples.size(); ++k)
    n_missing_[k + 1] = n_missing_[k] + (std::isfinite(samples[k]) ? 0U : 1U);
  reach_s_ = 1.0 / (band.low_hz + band.high_hz);

  // Both ends are continued by the record turned about its last value, which keeps the slope; it fades out.
  const std::vector<double> record = bridged_and_level(samples);
  const std::size_t n = record.size(), lead = n / 2;
  const int n_fft = next_power_of_two(static_cast<int>(n + 2 * lead));
  std::vector<double> padded(static_cast<std::size_t>(n_fft), 0.0);
  for (std::size_t k = 0; k < n; ++k) padded[lead + k] = record[k];
  for (std::size_t k = 0; k < lead; ++k) {
    const double fade = 0.5 + 0.5 * std::cos(kPi * static_cast<double>(k + 1) / static_cast<double>(lead + 1));
    padded[lead - 1 - k] = fade * (2.0 * record.front() - record[std::min(k + 1, n - 1)]);
    padded[lead + n + k] = fade * (2.0 * record.back() - record[n - 2 - std::min(k, n - 2)]);
  }
  RealFft forward(n_fft);
  std::vector<std::complex<double>> spectrum(static_cast<std::size_t>(forward.n_bins()));
  forward.forward(padded, spectrum);

  int n_out = n_fft;
  while (rate_hz * n_out / n_fft < kOutputPerPeriod * band.high_hz) n_out *= 2;
  while (n_out > 8 && 0.5 * rate_hz * n_out / n_fft >= kOutputPerPeriod * band.high_hz) n_out /= 2;
  out_rate_hz_ = rate_hz * n_out / n_fft;
  lead_s_ = static_cast<double>(lead) / rate_hz;
  const double edge = edge_hz(band, duration_s_);
  RealFft backward(n_out);
  std::vector<std::complex<double>> passed(static_cast<std::size_t>(backward.n_bins()));
  const double scale = static_cast<double>(n_out) / n_fft;
  for (std::size_t k = 1; k < std::min(passed.size(), spectrum.size()); ++k) {
    const double f_hz = static_cast<double>(k) * rate_hz / n_fft;
    const double weight = pass(f_hz, band, edge);
    if (weight == 0.0) continue;
    passed[k] = spectrum[k] * (scale * weight) / std::pow(std::complex<double>(0.0, kTwoPi * f_hz), n_integrations);
  }
  value_.resize(static_cast<std::size_t>(n_out));
  backward.inverse(passed, value_);
}

// Lagrange's polynomial through the six nearest samples.
double BandLimited::at(double t_s) const noexcept {
  const double place = (t_s + lead_s_) * out_rate_hz_;
  const double first = std::floor(place) - 2.0;
  if (!(t_s >= 0.0 && t_s <= duration_s_) || first < 0.0 || first + 6.0 > static_cast<double>(value_.size()))
    return 0.0;
  const auto begin = static_cast<std::size_t>(first);
  const double x = place - first;
  double sum = 0.0;
  for (std::size_t i = 0; i < 6; ++i) {
    double weight = 1.0;
    for (std::size_t j = 0; j < 6; ++j) {
      if (j != i) weight *= (x - static_cast<double>(j)) / (static_cast<double>(i) - static_cast<double>(j));
    }
    sum += weight * value_[begin + i];
  }
  return sum;
}

double BandLimited::slope_at(double t_s) const noexcept {
  const double h = 0.5 / out_rate_hz_;
  const double near = at(t_s + h) - at(t_s - h), far = at(t_s + 2.0 * h) - at(t_s - 2.0 * h);
  return (8.0 * near - far) / (12.0 * h);
}

bool BandLimited::is_seen(double t_s) const noexcept {
  const auto n = static_cast<double>(n_missing_.size() - 1);
  const double from = (t_s - reach_s_) * rate_hz_, to = (t_s + reach_s_) * rate_hz_;
  const double first = std::clamp(std::ceil(from), 0.0, n), last = std::clamp(std::floor(to) + 1.0, 0.0, n);
  if (!(t_s >= 0.0 && t_s <= duration_s_) || last <= first) return false;
  return n_missing_[static_cast<std::size_t>(last)] == n_missing_[static_cast<std::size_t>(first)];
}

}  // namespace core

#include "core/compare/offset_search.h"

#include <algorithm>
#include <cmath>

#include "core/spectrum/real_fft.h"

namespace core {
namespace {

constexpr double kCoarsePerPeriod = 12.0;  // samples of the search in a period of the upper limit

// Evidence for a correlation r of two records in the band over this time: that of 2 B T independent samples.
double evidence_of(double r, double overlap_s, const Band& band) {
  return -band.width_hz() * overlap_s * std::log(std::max(1e-15, 1.0 - r * r));
}

}  // namespace

OffsetSearch::Samples::Samples(const BandLimited& record, double from_s, double to_s, double rate_hz) {
  const auto n = static_cast<std::size_t>(std::max(0.0, std::floor((to_s - from_s) * rate_hz)));
  for (std::size_t k = 0; k < n; ++k) {
    const double t_s = from_s + static_cast<double>(k) / rate_hz;
    value.push_back(record.is_seen(t_s) ? record.at(t_s) : 0.0);
    squares.push_back(squares.back() + value.back() * value.back());
  }
}

double OffsetSearch::Samples::power(std::ptrdiff_t from, std::ptrdiff_t to) const {
  return squares[static_cast<std::size_t>(to)] - squares[static_cast<std::size_t>(from)];
}

OffsetSearch::OffsetSearch(const BandLimited& camera, const BandLimited& sensor, const Band& band, double from_s,
                           double to_s)
    : band_(band),
      rate_hz_(kCoarsePerPeriod * band.high_hz),
      from_s_(from_s),
      camera_(camera, from_s, to_s, rate_hz_),
      sensor_(sensor, 0.0, sensor.duration_s(), rate_hz_) {}

std::vector<CoarseOffset> OffsetSearch::peaks(double most_offset_s) {
  const auto n_camera = static_cast<std::ptrdiff_t>(camera_.value.size());
  const auto n_sensor = static_cast<std::ptrdiff_t>(sensor_.value.size());
  if (n_camera < 8 || n_sensor < 8) return {};
  correlate();
  const std::ptrdiff_t least_overlap = std::min(n_camera, n_sensor) / 2;
  std::vector<CoarseOffset> all;
  for (std::ptrdiff_t lag = least_overlap - n_camera; lag <= n_sensor - least_overlap; ++lag) {
    const double offset_s = static_cast<double>(lag) / rate_hz_ - from_s_;
    if (most_offset_s > 0.0 && std::abs(offset_s) > most_offset_s) continue;
    const std::ptrdiff_t first = std::max<std::ptrdiff_t>(0, -lag), last = std::min(n_camera, n_sensor - lag);
    const double power = camera_.power(first, last) * sensor_.power(first + lag, last + lag);
    const double r = power > 0.0 ? product(lag) / std::sqrt(power) : 0.0;
    all.push_back({offset_s, evidence_of(std::clamp(r, -1.0, 1.0), static_cast<double>(last - first) / rate_hz_, band_),
                   r < 0.0});
  }
  n_tried_ = all.size();
  std::vector<CoarseOffset> out;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const bool rises = k == 0 || all[k].evidence > all[k - 1].evidence || all[k].negative != all[k - 1].negative;
    const bool falls =
        k + 1 == all.size() || all[k].evidence >= all[k + 1].evidence || all[k].negative != all[k + 1].negative;
    if (rises && falls) out.push_back(all[k]);
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.evidence > b.evidence; });
  return out;
}

double OffsetSearch::n_trials() const {
  return std::max(2.0, static_cast<double>(n_tried_) * 2.0 * band_.width_hz() / rate_hz_);
}

void OffsetSearch::correlate() {
  n_fft_ = next_power_of_two(static_cast<int>(camera_.value.size() + sensor_.value.size() + 1));
  RealFft fft(n_fft_);
  const auto transform = [&](const std::vector<double>& value) {
    std::vector<double> padded(static_cast<std::size_t>(n_fft_), 0.0);
    std::copy(value.begin(), value.end(), padded.begin());
    std::vector<std::complex<double>> out(static_cast<std::size_t>(fft.n_bins()));
    fft.forward(padded, out);
    return out;
  };
  std::vector<std::complex<double>> a = transform(camera_.value);
  const std::vector<std::complex<double>> b = transform(sensor_.value);
  for (std::size_t k = 0; k < a.size(); ++k) a[k] = std::conj(a[k]) * b[k];
  correlation_.resize(static_cast<std::size_t>(n_fft_));
  fft.inverse(a, correlation_);
}

double OffsetSearch::product(std::ptrdiff_t lag) const {
  return correlation_[static_cast<std::size_t>(lag < 0 ? lag + n_fft_ : lag)];
}

}  // namespace core

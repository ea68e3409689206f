#include "core/closure/response/logger_phases.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>

#include "core/linear/median.h"
#include "core/spectrum/real_fft.h"
#include "core/types/constants.h"

namespace core::closure {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::VectorXd;
using Spectrum = std::vector<Complex>;

constexpr double kShortest_s = 5.0, kPhaseHighShare = 0.2;
constexpr std::size_t kFewest = 256;

[[noreturn]] void refuse_loggers(const std::string& what) { throw std::invalid_argument("loggers: " + what); }

std::vector<double> about_mean(std::vector<double> values) {
  double sum = 0.0, n = 0.0;
  for (const double v : values) {
    if (std::isfinite(v)) sum += v, n += 1.0;
  }
  for (double& v : values) v = std::isfinite(v) ? v - sum / std::max(n, 1.0) : 0.0;
  return values;
}

Spectrum transform(const double* from, std::size_t length, RealFft& fft, bool tapered) {
  std::vector<double> padded(static_cast<std::size_t>(fft.size()), 0.0);
  for (std::size_t k = 0; k < length; ++k) {
    const double x = kTwoPi * (static_cast<double>(k) + 0.5) / static_cast<double>(length);
    padded[k] = from[k] * (tapered ? 0.5 - 0.5 * std::cos(x) : 1.0);
  }
  Spectrum out(static_cast<std::size_t>(fft.n_bins()));
  fft.forward(padded, out);
  return out;
}

struct Band {
  double low_hz, high_hz;
  [[nodiscard]] bool holds(double hz) const noexcept { return hz >= low_hz && hz <= high_hz; }
};

// Offset in samples of a record relative to the first one, up to a quarter of the transform.
std::ptrdiff_t coarse_offset(const std::vector<double>& own, const std::vector<double>& first, double rate_hz,
                             const Band& band) {
  RealFft fft(next_power_of_two(static_cast<int>(4 * std::max(own.size(), first.size()))));
  const Spectrum a = transform(own.data(), own.size(), fft, false);
  const Spectrum b = transform(first.data(), first.size(), fft, false);
  Spectrum doubled(a.size(), 0.0);
  for (std::size_t k = 1; k + 1 < a.size(); ++k) {
    const Complex cross = a[k] * std::conj(b[k]);
    const double hz = rate_hz * static_cast<double>(k) / fft.size();
    if (band.holds(hz) && std::abs(cross) > 0.0) doubled[k] = cross * cross / std::norm(cross);
  }
  std::vector<double> lags(static_cast<std::size_t>(fft.size()));
  fft.inverse(doubled, lags);
  const auto n = static_cast<std::ptrdiff_t>(lags.size());
  std::ptrdiff_t lag = std::max_element(lags.begin(), lags.end()) - lags.begin();
  if (lag > n / 2) lag -= n;
  return static_cast<std::ptrdiff_t>(std::llround(-0.5 * static_cast<double>(lag)));
}

void check(const LoggerRecords& records) {
  if (records.value.size() < 2) refuse_loggers("two records or more");
  if (records.name.size() != records.value.size()) refuse_loggers("a name for each record");
  if (!(records.rate_hz > 0.0)) refuse_loggers("a rate above 0");
  for (std::size_t i = 0; i < records.value.size(); ++i) {
    const std::size_t n = records.value[i].size();
    if (n < kFewest || static_cast<double>(n) < kShortest_s * records.rate_hz)
      refuse_loggers(records.name[i] + " has " + std::to_string(n) + " samples; 5 s and 256 samples are the least");
  }
}

// Weights the stronger half of the bins, separately for those in which all loggers move as one.
void weigh(const std::vector<double>& size, const VectorXd& frequency_hz, double rigid_below_hz, VectorXd& weight) {
  std::vector<double> low, high;
  for (std::size_t b = 0; b < size.size(); ++b)
    (frequency_hz(static_cast<Index>(b)) < rigid_below_hz ? low : high).push_back(size[b]);
  const double least_low = low.empty() ? 0.0 : median(low), least_high = high.empty() ? 0.0 : median(high);
  for (std::size_t b = 0; b < size.size(); ++b) {
    const double least = frequency_hz(static_cast<Index>(b)) < rigid_below_hz ? least_low : least_high;
    weight(static_cast<Index>(b)) = size[b] >= least && size[b] > 0.0 ? 1.0 : 0.0;
  }
}

}  // namespace

LoggerPhases logger_phases(const LoggerRecords& records, std::size_t n_parts) {
  check(records);
  const double rate_hz = records.rate_hz;
  const Band band{records.band_low_hz, records.band_high_hz > 0.0 ? records.band_high_hz : kPhaseHighShare * rate_hz};
  std::vector<std::vector<double>> value;
  for (const auto& one : records.value) value.push_back(about_mean(one));
  std::vector<std::ptrdiff_t> late(value.size(), 0);
  std::ptrdiff_t from = 0, to = static_cast<std::ptrdiff_t>(value[0].size());
  for (std::size_t i = 1; i < value.size(); ++i) {
    late[i] = coarse_offset(value[i], value[0], rate_hz, band);
    from = std::max(from, late[i]);
    to = std::min(to, static_cast<std::ptrdiff_t>(value[i].size()) + late[i]);
  }
  const auto parts = static_cast<std::ptrdiff_t>(n_parts);
  const std::ptrdiff_t length = (to - from) / parts;
  if (length < static_cast<std::ptrdiff_t>(kFewest / n_parts))
    refuse_loggers("the records hardly overlap once their offsets are undone");
  RealFft fft(next_power_of_two(static_cast<int>(length)));
  std::vector<Index> bins;
  for (Index k = 1; k + 1 < fft.n_bins(); ++k) {
    if (band.holds(rate_hz * static_cast<double>(k) / fft.size())) bins.push_back(k);
  }
  if (bins.size() < 8) refuse_loggers("too few bins between the band's limits");
  LoggerPhases out;
  out.frequency_hz.resize(static_cast<Index>(bins.size()));
  for (std::size_t b = 0; b < bins.size(); ++b)
    out.frequency_hz(static_cast<Index>(b)) = rate_hz * static_cast<double>(bins[b]) / fft.size();
  for (std::ptrdiff_t part = 0; part < parts; ++part)
    out.part_time_s.push_back((static_cast<double>(part) - 0.5 * static_cast<double>(parts - 1)) *
                              static_cast<double>(length) / rate_hz);
  for (std::size_t i = 0; i < value.size(); ++i) {
    out.coarse_s.push_back(static_cast<double>(late[i]) / rate_hz);
    auto& phases = out.phase.emplace_back();
    auto& weights = out.weight.emplace_back();
    for (std::ptrdiff_t part = 0; part < parts; ++part) {
      const std::ptrdiff_t at = from + part * length;
      const Spectrum a = transform(value[i].data() + at - late[i], static_cast<std::size_t>(length), fft, true);
      const Spectrum b = transform(value[0].data() + at, static_cast<std::size_t>(length), fft, true);
      VectorXd phase(out.frequency_hz.size()), weight(out.frequency_hz.size());
      std::vector<double> size;
      for (std::size_t k = 0; k < bins.size(); ++k) {
        const Complex cross = a[static_cast<std::size_t>(bins[k])] * std::conj(b[static_cast<std::size_t>(bins[k])]);
        size.push_back(std::abs(cross));
        phase(static_cast<Index>(k)) =
            std::arg(cross) + kTwoPi * out.frequency_hz(static_cast<Index>(k)) * out.coarse_s[i];
      }
      weigh(size, out.frequency_hz, records.rigid_below_hz, weight);
      phases.push_back(std::move(phase));
      weights.push_back(std::move(weight));
    }
  }
  return out;
}

}  // namespace core::closure

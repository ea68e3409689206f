#include "firmware_app/replay/series_channels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/spectrum/decimator.h"

namespace app {

namespace {

// Relative to the largest value: variation of a constant by rounding.
constexpr double kLeastMotion = 1e-12;
constexpr double kLargestMotion = 1e50;  // its fourth power is still finite
// Of 1 - |correlation|: a smaller value means a copy of a channel with other rounding.
constexpr double kLeastDifference = 1e-9;

struct Moments {
  double count = 0.0;
  double mean = 0.0;
  double sum_of_squares = 0.0;  // about the mean
  double largest = 0.0;
};

Moments moments_of(const std::vector<double>& values) {
  Moments m;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    m.count += 1.0;
    m.largest = std::max(m.largest, std::abs(value));
    const double off = value - m.mean;
    m.mean += off / m.count;
    m.sum_of_squares += off * (value - m.mean);
  }
  return m;
}

bool stands_still(const Moments& m) { return !(std::sqrt(m.sum_of_squares / m.count) > kLeastMotion * m.largest); }

// A few samples of channels of equal length suffice to tell most of them apart.
bool is_alike_in_places(const std::vector<double>& a, const Moments& of_a, const std::vector<double>& b,
                        const Moments& of_b) {
  constexpr std::size_t kPlaces = 16;
  constexpr double kAlike = 0.05;  // of the rms: copies differ by the square root of 2 kLeastDifference, rms
  const double rms_a = std::sqrt(of_a.sum_of_squares / of_a.count), rms_b = std::sqrt(of_b.sum_of_squares / of_b.count);
  bool same = true, opposite = true;
  for (std::size_t k = 0; k < kPlaces; ++k) {
    const std::size_t t = k * a.size() / kPlaces;
    if (!std::isfinite(a[t]) || !std::isfinite(b[t])) continue;
    const double x = (a[t] - of_a.mean) / rms_a, y = (b[t] - of_b.mean) / rms_b;
    same = same && std::abs(x - y) < kAlike, opposite = opposite && std::abs(x + y) < kAlike;
  }
  return same || opposite;
}

bool is_copy(const std::vector<double>& a, const Moments& of_a, const std::vector<double>& b, const Moments& of_b) {
  if (!is_alike_in_places(a, of_a, b, of_b)) return false;
  double cross = 0.0;
  for (std::size_t t = 0; t < a.size(); ++t) {
    if (std::isfinite(a[t]) != std::isfinite(b[t])) return false;
    if (std::isfinite(a[t])) cross += (a[t] - of_a.mean) * (b[t] - of_b.mean);
  }
  const double power = std::sqrt(of_a.sum_of_squares) * std::sqrt(of_b.sum_of_squares);
  return std::abs(cross) >= (1.0 - kLeastDifference) * power;
}

// Why a channel cannot be used together with those kept so far; empty: it can.
std::string reason_to_leave_out(const ChannelSeries& series, const std::vector<Moments>& moments,
                                const std::vector<std::size_t>& kept, std::size_t c) {
  if (moments[c].count == 0.0) return "it has no sample";
  if (stands_still(moments[c])) return fmt::format("it is constant ({:g})", moments[c].mean);
  const double rms = std::sqrt(moments[c].sum_of_squares / moments[c].count);
  if (!(rms < kLargestMotion && rms > 1.0 / kLargestMotion))
    return fmt::format("an rms of {:.3g} is beyond any unit of motion", rms);
  for (const std::size_t k : kept) {
    if (is_copy(series.value[k], moments[k], series.value[c], moments[c]))
      return fmt::format("it is a copy or a multiple of {}", series.channels[k].name);
  }
  return {};
}

std::vector<int> renumbered(const std::vector<int>& references, const std::vector<std::size_t>& kept) {
  std::vector<int> out;
  for (const int reference : references) {
    const auto at = std::find(kept.begin(), kept.end(), static_cast<std::size_t>(reference));
    if (at != kept.end()) out.push_back(static_cast<int>(at - kept.begin()));
  }
  return out;
}

}  // namespace

void leave_out_unusable(ChannelSeries& series, std::vector<int>& references, std::vector<std::string>& remarks) {
  std::vector<Moments> moments;
  for (const auto& values : series.value) moments.push_back(moments_of(values));
  std::vector<std::size_t> kept;
  std::string last_reason = "the record has none";
  for (std::size_t c = 0; c < series.channels.size(); ++c) {
    const std::string reason = reason_to_leave_out(series, moments, kept, c);
    if (reason.empty()) {
      kept.push_back(c);
      continue;
    }
    last_reason = series.channels[c].name + ": " + reason;
    remarks.push_back(fmt::format("channel {} is left out: {}", series.channels[c].name, reason));
  }
  if (kept.empty()) throw std::invalid_argument("no channel is left to identify from (" + last_reason + ")");
  const std::vector<int> left = renumbered(references, kept);
  if (!references.empty() && left.empty()) throw std::invalid_argument("no reference is left (" + last_reason + ")");
  references = left;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i] == i) continue;
    series.channels[i] = series.channels[kept[i]];
    series.value[i] = std::move(series.value[kept[i]]);
  }
  series.channels.resize(kept.size());
  series.value.resize(kept.size());
}

int decimate_to(ChannelSeries& series, double max_frequency_hz, std::vector<std::string>& remarks) {
  const int factor = core::decimation_factor(series.rate_hz, max_frequency_hz);
  if (factor == 1) return 1;
  const core::Decimator decimator(factor);
  for (auto& values : series.value) values = decimator.decimate(values);
  const double rate_hz = series.rate_hz / factor;
  remarks.push_back(fmt::format("decimated by {}: {:g} -> {:g} Hz, poles above {:.4g} Hz are not evaluated", factor,
                                series.rate_hz, rate_hz, core::Decimator::kPassband * rate_hz));
  series.rate_hz = rate_hz;
  return factor;
}

int automatic_segment(std::size_t n_samples) noexcept {
  // In short records a segment must still resolve the modes: 512 samples if one and a half such segments fit.
  const int least = n_samples >= 768 ? 9 : 6;
  const double eighth = std::max(1.0, static_cast<double>(n_samples) / 8.0);
  return 1 << std::clamp(static_cast<int>(std::lround(std::log2(eighth))), least, 12);
}

}  // namespace app

#include "firmware_app/replay/series_faults.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/spectrum/outlier_gate.h"

namespace app {

namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
// Distance from all other values, in units of the range from their 1 % to their 99 % quantile.
constexpr double kFillDistance = 20.0;
constexpr std::size_t kLeastSamples = 32;
// A stuck stretch has at least this length, ten times the 90 % quantile of the channel's stretches, and more than a
// hundredth of the record.
constexpr std::size_t kLeastStuck = 16;
constexpr double kStuckOverUsual = 10.0, kStuckShare = 0.01;
// Number of values in the next fiftieth of the range below a clipped extreme: an unclipped peak passes through it.
constexpr double kSaturationBand = 0.02, kSaturationRatio = 3.0, kLeastSaturated = 0.001;
constexpr std::size_t kLeastSaturatedSamples = 8, kLeastLevels = 200;

std::vector<double> sorted_values(const std::vector<double>& values) {
  std::vector<double> out;
  for (const double x : values) {
    if (std::isfinite(x)) out.push_back(x);
  }
  std::sort(out.begin(), out.end());
  return out;
}

double quantile(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

class ChannelFaults {
 public:
  ChannelFaults(ChannelSeries& series, std::size_t c, std::vector<std::string>& remarks)
      : series_(series), name_(series.channels[c].name), values_(series.value[c]), c_(c), remarks_(remarks) {}

  // Returns the number of outliers.
  std::uint64_t mask() {
    if (sorted_values(values_).size() < kLeastSamples) return 0;
    mask_fill_values();
    mask_stuck();
    name_saturation();
    return mask_outliers();
  }

 private:
  [[nodiscard]] std::string at(std::size_t t) const {
    return fmt::format("{:.4g} s", static_cast<double>(t) / series_.rate_hz);
  }

  // The middle of the values, without possible fill values: at most a third of the values on either side.
  void mask_fill_values() {
    for (;;) {
      const std::vector<double> sorted = sorted_values(values_);
      if (sorted.size() < kLeastSamples) return;
      const double value = std::abs(sorted.back()) > std::abs(sorted.front()) ? sorted.back() : sorted.front();
      const auto n = static_cast<std::size_t>(std::count(sorted.begin(), sorted.end(), value));
      if (3 * n > sorted.size()) return;
      std::vector<double> others;
      std::copy_if(sorted.begin(), sorted.end(), std::back_inserter(others), [&](double x) { return x != value; });
      if (others.size() < kLeastSamples) return;
      const double range = quantile(others, 0.99) - quantile(others, 0.01);
      const double beyond = std::max(value - others.back(), others.front() - value);
      const bool is_isolated =
          beyond > kFillDistance * range && beyond > kFillDistance * (others.back() - others.front());
      if (!(range > 0.0) || !is_isolated) return;
      const auto first = static_cast<std::size_t>(std::find(values_.begin(), values_.end(), value) - values_.begin());
      std::replace(values_.begin(), values_.end(), value, kMissing);
      remarks_.push_back(fmt::format("{}: {} sample{} of {:g} (first at {}) {} treated as missing: a fill value", name_,
                                     n, n == 1 ? "" : "s", value, at(first), n == 1 ? "is" : "are"));
    }
  }

  struct Run {
    std::size_t first = 0, n = 0;
  };
  [[nodiscard]] std::vector<Run> runs() const {
    std::vector<Run> out;
    for (std::size_t t = 0; t < values_.size();) {
      std::size_t end = t + 1;
      while (end < values_.size() && values_[end] == values_[t]) ++end;
      if (std::isfinite(values_[t])) out.push_back({t, end - t});
      t = end;
    }
    return out;
  }
  // Does any other channel move in the stretch? If none does, the structure may be at rest.
  [[nodiscard]] bool others_move(const Run& run) const {
    for (std::size_t c = 0; c < series_.value.size(); ++c) {
      if (c == c_) continue;
      const auto first = series_.value[c].begin() + static_cast<std::ptrdiff_t>(run.first);
      const double value = *first;
      const auto differs = [&](double x) { return std::isfinite(x) && std::isfinite(value) && x != value; };
      if (std::count_if(first, first + static_cast<std::ptrdiff_t>(run.n), differs) * 2 >
          static_cast<std::ptrdiff_t>(run.n))
        return true;
    }
    return series_.value.size() == 1;
  }
  void mask_stuck() {
    const std::vector<Run> all = runs();
    if (all.size() < 4) return;  // hardly ever moves: the other tests decide
    std::vector<std::size_t> lengths;
    for (const Run& run : all) lengths.push_back(run.n);
    std::sort(lengths.begin(), lengths.end());
    const auto usual = static_cast<double>(lengths[(lengths.size() - 1) * 9 / 10]);
    std::size_t n_stuck = 0, first = 0;
    double value = 0.0;
    for (const Run& run : all) {
      const auto n = static_cast<double>(run.n);
      if (run.n < kLeastStuck || n < kStuckOverUsual * usual || n < kStuckShare * static_cast<double>(values_.size()) ||
          !others_move(run))
        continue;
      if (n_stuck == 0) first = run.first, value = values_[run.first];
      n_stuck += run.n;
      std::fill_n(values_.begin() + static_cast<std::ptrdiff_t>(run.first), run.n, kMissing);
    }
    if (n_stuck > 0)
      remarks_.push_back(fmt::format("{}: stuck at {:g} from {} on, {:.3g} % of the record: treated as missing", name_,
                                     value, at(first),
                                     100.0 * static_cast<double>(n_stuck) / static_cast<double>(values_.size())));
  }

  void name_saturation() {
    const std::vector<double> sorted = sorted_values(values_);
    if (sorted.size() < kLeastSamples) return;
    std::vector<double> levels = sorted;
    levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
    if (levels.size() < kLeastLevels) return;  // coarse steps: every peak is flat
    const double band = kSaturationBand * (sorted.back() - sorted.front());
    for (const bool is_top : {true, false}) {
      const double extreme = is_top ? sorted.back() : sorted.front();
      const auto is_extreme = [&](double x) { return x == extreme; };
      const auto is_beside = [&](double x) { return x != extreme && std::abs(x - extreme) < band; };
      const auto n = static_cast<std::size_t>(std::count_if(sorted.begin(), sorted.end(), is_extreme));
      const auto n_beside = static_cast<double>(std::count_if(sorted.begin(), sorted.end(), is_beside));
      const double share = static_cast<double>(n) / static_cast<double>(sorted.size());
      if (n < kLeastSaturatedSamples || share < kLeastSaturated || static_cast<double>(n) < kSaturationRatio * n_beside)
        continue;
      remarks_.push_back(
          fmt::format("{}: {} samples ({:.2g} %) are exactly its {} value, {:g}: saturated? Its part of the "
                      "shapes and the damping are then wrong",
                      name_, n, 100.0 * share, is_top ? "largest" : "smallest", extreme));
    }
  }

  std::uint64_t mask_outliers() {
    core::OutlierGate gate(1);
    std::size_t n = 0, first = 0;
    double value = 0.0;
    const auto reject = [&](std::size_t t) {
      if (n++ == 0) first = t, value = values_[t];
      values_[t] = kMissing;
    };
    for (std::size_t t = 0; t < values_.size(); ++t) {
      const double x = values_[t];
      if (gate.push(0, x, std::isfinite(x))) reject(t - 1);
    }
    if (gate.push(0, 0.0, false)) reject(values_.size() - 1);
    if (n > 0)
      remarks_.push_back(
          fmt::format("{}: {} sample{} (first {:g} at {}) {} masked: the neighbours in time do not allow {}", name_, n,
                      n == 1 ? "" : "s", value, at(first), n == 1 ? "is" : "are", n == 1 ? "it" : "them"));
    return n;
  }

  ChannelSeries& series_;
  std::string name_;
  std::vector<double>& values_;
  std::size_t c_;
  std::vector<std::string>& remarks_;
};

}  // namespace

std::vector<std::uint64_t> mask_faults(ChannelSeries& series, std::vector<std::string>& remarks) {
  std::vector<std::uint64_t> n_outlying;
  for (std::size_t c = 0; c < series.channels.size(); ++c)
    n_outlying.push_back(ChannelFaults(series, c, remarks).mask());
  return n_outlying;
}

}  // namespace app

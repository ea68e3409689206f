#include "core/identification/combine_estimates.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>
#include <tuple>

#include "core/identification/average_linkage.h"
#include "core/identification/mac.h"

namespace core {

namespace {

using Shape = std::vector<std::complex<double>>;
using Places = std::vector<ModePlace>;

constexpr double kFrequencyTolerance = 0.03;  // relative; as in merge_setups()
constexpr double kMacTolerance = 0.5;
constexpr double kFar = std::numeric_limits<double>::infinity();

class Matcher {
 public:
  explicit Matcher(const std::vector<EstimateInput>& estimates) : estimates_(estimates) {}

  [[nodiscard]] std::vector<Places> groups() const {
    std::vector<Places> groups;
    for (const Places& band : bands()) {
      std::vector<double> distances(band.size() * band.size(), 0.0);
      for (std::size_t i = 0; i < band.size(); ++i) {
        for (std::size_t j = i + 1; j < band.size(); ++j)
          distances[i * band.size() + j] = distances[j * band.size() + i] = distance(band[i], band[j]);
      }
      for (const auto& members : average_linkage(std::move(distances), band.size(), 1.0)) {
        Places& group = groups.emplace_back();
        for (const std::size_t member : members) group.push_back(band[member]);
        std::sort(group.begin(), group.end(),
                  [](const ModePlace& a, const ModePlace& b) { return a.i_estimate < b.i_estimate; });
      }
    }
    return groups;
  }

 private:
  [[nodiscard]] const Mode& mode(const ModePlace& place) const {
    return estimates_[place.i_estimate].estimate->modes[place.i_mode];
  }

  // All modes sorted by frequency and cut at gaps too wide for one mode: no pair across a cut can be joined.
  [[nodiscard]] std::vector<Places> bands() const {
    Places all;
    for (std::size_t e = 0; e < estimates_.size(); ++e) {
      for (std::size_t m = 0; m < estimates_[e].estimate->modes.size(); ++m) all.push_back({e, m});
    }
    std::sort(all.begin(), all.end(), [&](const ModePlace& a, const ModePlace& b) {
      return std::tuple(mode(a).frequency_hz, a.i_estimate, a.i_mode) <
             std::tuple(mode(b).frequency_hz, b.i_estimate, b.i_mode);
    });
    std::vector<Places> bands;
    for (const ModePlace& place : all) {
      if (bands.empty() || !(frequencies_apart(bands.back().back(), place) < 1.0)) bands.emplace_back();
      bands.back().push_back(place);
    }
    return bands;
  }

  [[nodiscard]] double frequencies_apart(const ModePlace& a, const ModePlace& b) const {
    const double mean_hz = 0.5 * (mode(a).frequency_hz + mode(b).frequency_hz);
    return std::abs(mode(a).frequency_hz - mode(b).frequency_hz) / (kFrequencyTolerance * mean_hz);
  }

  [[nodiscard]] double distance(const ModePlace& a, const ModePlace& b) const {
    if (a.i_estimate == b.i_estimate) return kFar;
    const auto mac = mac_of_common_channels(a, b);
    return frequencies_apart(a, b) + (mac ? (1.0 - *mac) / kMacTolerance : 0.0);
  }

  [[nodiscard]] std::optional<double> mac_of_common_channels(const ModePlace& a, const ModePlace& b) const {
    const auto& own = estimates_[a.i_estimate].channels;
    const auto& others = estimates_[b.i_estimate].channels;
    const Shape &own_shape = mode(a).shape, &other_shape = mode(b).shape;
    Shape one, two;
    for (std::size_t c = 0; c < std::min(own.size(), own_shape.size()); ++c) {
      const auto at = static_cast<std::size_t>(std::find(others.begin(), others.end(), own[c]) - others.begin());
      if (at >= std::min(others.size(), other_shape.size())) continue;
      one.push_back(own_shape[c]), two.push_back(other_shape[at]);
    }
    if (one.size() < 2) return std::nullopt;
    return mac(one, two);
  }

  const std::vector<EstimateInput>& estimates_;
};

// Value and std of one mode; empty: the mode is excluded.
using Reading = std::optional<Measured> (*)(const Mode& mode);

std::optional<Measured> frequency_of(const Mode& mode) {
  return Measured{mode.frequency_hz, mode.frequency_std_hz.value_or(0.0), 0.0};
}

std::optional<Measured> log_damping_of(const Mode& mode) {
  if (!(mode.damping_ratio > 0.0)) return std::nullopt;
  return Measured{std::log(mode.damping_ratio), mode.damping_std.value_or(0.0) / mode.damping_ratio, 0.0};
}

WeightedMean mean_of(const std::vector<EstimateInput>& estimates, const Places& members, Reading read) {
  std::vector<Measured> stated;
  double sum = 0.0, total_s = 0.0;
  std::size_t n = 0;
  for (const ModePlace& place : members) {
    const ModalEstimate& estimate = *estimates[place.i_estimate].estimate;
    std::optional<Measured> reading = read(estimate.modes[place.i_mode]);
    if (!reading) continue;
    const double duration_s = std::max(estimate.duration_s, std::numeric_limits<double>::min());
    sum += duration_s * reading->value, total_s += duration_s;
    ++n;
    reading->degrees_of_freedom = estimate.degrees_of_freedom;
    if (reading->std > 0.0 && std::isfinite(reading->std)) stated.push_back(*reading);
  }
  if (!stated.empty()) return inverse_variance_mean(stated);
  WeightedMean mean;
  mean.value = n > 0 ? sum / total_s : 0.0;
  mean.n = n;
  return mean;
}

}  // namespace

WeightedMean mean_frequency(const std::vector<EstimateInput>& estimates, const Places& members) {
  return mean_of(estimates, members, frequency_of);
}

WeightedMean mean_damping(const std::vector<EstimateInput>& estimates, const Places& members) {
  WeightedMean mean = mean_of(estimates, members, log_damping_of);
  if (mean.n == 0) return mean;
  mean.value = std::exp(mean.value);
  mean.std *= mean.value;
  return mean;
}

std::vector<ModeGroup> combine_estimates(const std::vector<EstimateInput>& estimates) {
  std::vector<ModeGroup> groups;
  for (Places& members : Matcher(estimates).groups()) {
    Places combined;
    for (const ModePlace& place : members) {
      if (estimates[place.i_estimate].is_combined) combined.push_back(place);
    }
    groups.push_back({std::move(members), mean_frequency(estimates, combined), mean_damping(estimates, combined)});
  }
  const auto hz = [&](const ModeGroup& group) {
    return group.frequency_hz.n > 0 ? group.frequency_hz.value : mean_frequency(estimates, group.members).value;
  };
  std::stable_sort(groups.begin(), groups.end(), [&](const ModeGroup& a, const ModeGroup& b) { return hz(a) < hz(b); });
  return groups;
}

}  // namespace core

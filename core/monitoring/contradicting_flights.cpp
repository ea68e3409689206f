#include "core/monitoring/contradicting_flights.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/identification/inverse_variance.h"
#include "core/linear/median.h"
#include "core/types/constants.h"

namespace core::monitoring {
namespace {

constexpr double kSigmas = 4.0, kLeastShare = 1e-3;
constexpr std::size_t kLeastOthers = 2, kLeastForLine = 5;
constexpr double kMostCommonScatter = 2.5;  // of the modes' shares about the common one, over their standard deviations
constexpr double kLikeNeighbour = 0.5;  // a neighbour in time with this part of the difference: the structure changed

// The number of standard deviations of Student's t that is as rare as `sigmas` of a normal one (Cornish and Fisher).
double as_rare(double sigmas, double degrees_of_freedom) {
  if (!(degrees_of_freedom > 0.0)) return sigmas;
  const double z = sigmas, z3 = z * z * z, nu = degrees_of_freedom;
  return z + (z3 + z) / (4.0 * nu) + (5.0 * z3 * z * z + 16.0 * z3 + 3.0 * z) / (96.0 * nu * nu);
}

// All modes of one flight against the medians over the flights.
struct Share {
  std::size_t flight = 0, n_modes = 0;
  Measured value;
  bool is_common = false;
  double kelvin = 0.0;
};

std::vector<Share> shares_of(const std::vector<FlightSeries>& modes, const Conditions& conditions) {
  std::vector<std::vector<Measured>> all(conditions.day.size());
  for (const FlightSeries& mode : modes) {
    std::vector<double> logarithms;
    for (const FlightValue& value : mode) logarithms.push_back(std::log(value.value));
    const double middle = median(logarithms);
    for (const FlightValue& value : mode)
      all[value.flight].push_back({std::log(value.value) - middle, value.std / value.value, value.degrees_of_freedom});
  }
  std::vector<Share> out;
  for (std::size_t f = 0; f < all.size(); ++f) {
    if (all[f].empty()) continue;
    const WeightedMean mean = inverse_variance_mean(all[f]);
    const double kelvin = conditions.temperature_c.empty() ? kNan : conditions.temperature_c[f];
    out.push_back({f,
                   all[f].size(),
                   {mean.value, mean.std, mean.degrees_of_freedom},
                   all[f].size() > 1 && mean.scatter.value_or(0.0) < kMostCommonScatter,
                   kelvin});
  }
  return out;
}

// What the other flights predict for one.
struct Prediction {
  double value = 0.0, variance = 0.0;  // of a flight with an exact frequency
};

// Weighted mean, or line over the temperature. The variance of a new flight holds the others' scatter beyond their own.
Prediction predict(const std::vector<Share>& shares, std::size_t own) {
  double w = 0.0, wt = 0.0, wy = 0.0;
  std::size_t n = 0, n_known = 0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    if (i == own) continue;
    const double weight = 1.0 / (shares[i].value.std * shares[i].value.std);
    w += weight, wy += weight * shares[i].value.value, ++n;
    if (std::isfinite(shares[i].kelvin)) wt += weight * shares[i].kelvin, ++n_known;
  }
  const bool has_line = n >= kLeastForLine && n_known == n && std::isfinite(shares[own].kelvin);
  const double mean = wy / w, mean_kelvin = wt / w;
  double wtt = 0.0, wty = 0.0;
  for (std::size_t i = 0; i < shares.size() && has_line; ++i) {
    if (i == own) continue;
    const double weight = 1.0 / (shares[i].value.std * shares[i].value.std), t = shares[i].kelvin - mean_kelvin;
    wtt += weight * t * t, wty += weight * t * (shares[i].value.value - mean);
  }
  const bool uses_line = has_line && wtt > kLeastTemperature_k * kLeastTemperature_k * w;
  const double slope = uses_line ? wty / wtt : 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    if (i == own) continue;
    const double t = uses_line ? shares[i].kelvin - mean_kelvin : 0.0;
    squares += std::pow((shares[i].value.value - mean - slope * t) / shares[i].value.std, 2);
  }
  const double freedom = static_cast<double>(n) - (uses_line ? 2.0 : 1.0), typical = static_cast<double>(n) / w;
  const double excess = std::max(0.0, squares / freedom - 1.0) * typical;
  const double t = uses_line ? shares[own].kelvin - mean_kelvin : 0.0;
  const double of_mean = 1.0 / w + (uses_line ? t * t / wtt : 0.0);
  return {mean + slope * t, excess + of_mean * (1.0 + excess / typical)};
}

struct Judged {
  ContradictingFlight flight;
  double excess = 0.0;  // difference over what chance allows; 1 or more: contradicts
};

Judged judge_flight(const std::vector<Share>& shares, std::size_t i) {
  const Prediction prediction = predict(shares, i);
  const Share& own = shares[i];
  const double difference = own.value.value - prediction.value;
  const double std = std::sqrt(own.value.std * own.value.std + prediction.variance);
  return {{own.flight, std::expm1(difference), std, own.n_modes, own.is_common},
          std > 0.0 ? std::abs(difference) / std / as_rare(kSigmas, own.value.degrees_of_freedom) : 0.0};
}

bool is_alone(const std::vector<Judged>& kept, std::size_t at) {
  const double share = kept[at].flight.share;
  const auto likewise = [&](std::size_t other) { return kept[other].flight.share / share > kLikeNeighbour; };
  return !(at > 0 && likewise(at - 1)) && !(at + 1 < kept.size() && likewise(at + 1));
}

}  // namespace

std::vector<ContradictingFlight> contradicting_flights(const std::vector<FlightSeries>& modes,
                                                       const Conditions& conditions) {
  std::vector<ContradictingFlight> out;
  std::vector<Share> shares = shares_of(modes, conditions);
  const std::size_t n_flights = shares.size();
  while (shares.size() > kLeastOthers && (out.size() + 1) * 3 <= n_flights) {
    std::vector<Judged> kept;
    for (std::size_t i = 0; i < shares.size(); ++i) kept.push_back(judge_flight(shares, i));
    std::optional<std::size_t> worst;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      if (kept[i].excess < 1.0 || std::abs(kept[i].flight.share) < kLeastShare || !is_alone(kept, i)) continue;
      if (!worst || kept[i].excess > kept[*worst].excess) worst = i;
    }
    if (!worst) break;
    out.push_back(kept[*worst].flight);
    shares.erase(shares.begin() + static_cast<std::ptrdiff_t>(*worst));
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.flight < b.flight; });
  return out;
}

}  // namespace core::monitoring

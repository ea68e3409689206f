#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace core::monitoring {

// One quantity (a frequency, a damping ratio, a component of a shape) as one flight measured it.
struct FlightValue {
  std::size_t flight = 0;           // index into Conditions
  double value = 0.0, std = 0.0;    // std > 0
  double degrees_of_freedom = 0.0;  // of std; 0 = std is exact
};
using FlightSeries = std::vector<FlightValue>;  // flights ascend

// Of every flight, in the order of time.
struct Conditions {
  std::vector<double> day;            // time in days, not decreasing
  std::vector<double> temperature_c;  // empty: not known; NaN: not known for this flight, whose values are left out
};

// A step or a trend needs this many flights on either side, so that one odd flight is no change.
inline constexpr std::size_t kLeastFlightsBeside = 3;
inline constexpr std::size_t kLeastFlights = 2 * kLeastFlightsBeside;
// Temperature is a regressor where its standard deviation over the flights is at least this.
inline constexpr double kLeastTemperature_k = 0.5;

enum class ChangeKind : std::uint8_t { kStep, kTrend };

// What one series shows.
struct Change {
  bool is_tested = false;  // false: fewer than kLeastFlights values
  bool is_significant = false;
  ChangeKind kind = ChangeKind::kStep;
  bool kind_is_clear = false;    // the other kind explains the series worse by more than chance (95 %)
  std::size_t first_flight = 0;  // of a step: the first flight after it
  // Step: mean after minus mean before. Trend: per day. Both at equal temperature where it is known.
  double size = 0.0, size_std = 0.0;
  // Chance that any series of the family shows as much without a change.
  double chance = 1.0;
  // With known temperatures that vary: change per kelvin; else 0 with std 0.
  double per_kelvin = 0.0, per_kelvin_std = 0.0;
  double scatter = 0.0;  // of the values about what was fitted, over what their std implies; 1: std holds
  double mean = 0.0;     // of all values, at the mean temperature, before any change
};

// Tests each series for one step or one linear trend, beside a constant and the temperature. Weighted least squares;
// the statistic is the largest decrease of the weighted squares over all candidates, in units of the residual variance
// where that exceeds 1 (flights differ by more than they state). Its distribution comes from series without a change on
// the same flights: errors with Student's distribution and the residual variance seen, and the flights' own residuals,
// resampled with random signs; the larger chance counts. The largest statistic of all series of such a set gives the
// chance that *any* series of the family is wrongly reported [Westfall & Young 1993].
//
// level: that chance, e.g. 0.005. The same input gives the same result (fixed seed, fixed order of the sums).
[[nodiscard]] std::vector<Change> test_changes(const Conditions& conditions, const std::vector<FlightSeries>& family,
                                               double level);

}  // namespace core::monitoring

// Tests of changes over flights: steps, trends, temperature, and flights that contradict the others.
#include <gtest/gtest.h>

#include <cmath>

#include "core/monitoring/change_test.h"
#include "core/monitoring/contradicting_flights.h"
#include "core/simulation/random_stream.h"

namespace core::monitoring {
namespace {

constexpr std::size_t kFlights = 30;
constexpr double kSigma = 0.01, kFreedom = 8.0, kLevel = 0.005;

Conditions two_years(bool with_temperature) {
  Conditions out;
  for (std::size_t k = 0; k < kFlights; ++k) {
    out.day.push_back(25.0 * static_cast<double>(k));
    if (with_temperature) out.temperature_c.push_back(10.0 + 8.0 * std::sin(0.43 * static_cast<double>(k)));
  }
  return out;
}

// Noise of kSigma about `course` of the flight's number.
template <class Course>
FlightSeries series_of(std::uint64_t seed, Course course) {
  simulation::RandomStream noise(seed, "series");
  FlightSeries out;
  for (std::size_t k = 0; k < kFlights; ++k)
    out.push_back({k, course(k) + kSigma * noise.gaussian(), kSigma, kFreedom});
  return out;
}

TEST(ChangeTest, FindsAStepWhereItIs) {
  const auto step = [](std::size_t k) { return 2.0 + (k >= 12 ? -0.04 : 0.0); };
  const auto found = test_changes(two_years(false), {series_of(1, step)}, kLevel);
  ASSERT_TRUE(found[0].is_significant);
  EXPECT_EQ(found[0].kind, ChangeKind::kStep);
  EXPECT_TRUE(found[0].kind_is_clear);
  EXPECT_NEAR(static_cast<double>(found[0].first_flight), 12.0, 1.0);
  EXPECT_NEAR(found[0].size, -0.04, 3.0 * found[0].size_std);
  EXPECT_NEAR(found[0].mean, 2.0, 0.01);
}

TEST(ChangeTest, FindsATrendPerDay) {
  const auto trend = [](std::size_t k) { return 2.0 - 8e-5 * 25.0 * static_cast<double>(k); };
  const auto found = test_changes(two_years(false), {series_of(2, trend)}, kLevel);
  ASSERT_TRUE(found[0].is_significant);
  EXPECT_EQ(found[0].kind, ChangeKind::kTrend);
  EXPECT_NEAR(found[0].size, -8e-5, 3.0 * found[0].size_std);
}

TEST(ChangeTest, TemperatureIsNoChangeAndItsSlopeIsReported) {
  const Conditions conditions = two_years(true);
  const auto warm = [&](std::size_t k) { return 2.0 - 0.01 * (conditions.temperature_c[k] - 10.0); };
  const auto found = test_changes(conditions, {series_of(3, warm)}, kLevel);
  EXPECT_FALSE(found[0].is_significant);
  EXPECT_NEAR(found[0].per_kelvin, -0.01, 4.0 * found[0].per_kelvin_std);
}

TEST(ChangeTest, FlightsWithoutTemperatureAreLeftOut) {
  Conditions conditions = two_years(true);
  conditions.temperature_c[5] = std::nan("");
  FlightSeries series = series_of(4, [](std::size_t) { return 2.0; });
  series[5].value = 50.0;
  EXPECT_FALSE(test_changes(conditions, {series}, kLevel)[0].is_significant);
}

TEST(ChangeTest, FalseReportsOfAFamilyAreRare) {
  int n_false = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    std::vector<FlightSeries> family;
    for (std::uint64_t i = 0; i < 5; ++i) family.push_back(series_of(100 * seed + i, [](std::size_t) { return 1.0; }));
    for (const Change& one : test_changes(two_years(true), family, kLevel)) n_false += one.is_significant ? 1 : 0;
  }
  EXPECT_LE(n_false, 1);
}

TEST(ChangeTest, ScatterBeyondTheStatedSigmaIsNoChange) {
  FlightSeries series = series_of(5, [](std::size_t) { return 1.0; });
  for (FlightValue& value : series) value.std /= 4.0;
  const auto found = test_changes(two_years(false), {series}, kLevel);
  EXPECT_FALSE(found[0].is_significant);
  EXPECT_GT(found[0].scatter, 2.0);
}

TEST(ChangeTest, FewFlightsAreNotTested) {
  FlightSeries series = series_of(6, [](std::size_t) { return 1.0; });
  series.resize(kLeastFlights - 1);
  const auto found = test_changes(two_years(false), {series, {}}, kLevel);
  EXPECT_FALSE(found[0].is_tested);
  EXPECT_FALSE(found[1].is_tested);
}

TEST(ChangeTest, TheSameFlightsGiveTheSameBits) {
  const FlightSeries series = series_of(7, [](std::size_t k) { return k >= 20 ? 1.02 : 1.0; });
  const auto one = test_changes(two_years(true), {series}, kLevel),
             two = test_changes(two_years(true), {series}, kLevel);
  EXPECT_EQ(one[0].chance, two[0].chance);
  EXPECT_EQ(one[0].size, two[0].size);
}

Conditions days(std::size_t n) {
  Conditions out;
  for (std::size_t k = 0; k < n; ++k) out.day.push_back(static_cast<double>(k));
  return out;
}

// Modes of several flights; `factor` of each.
std::vector<FlightSeries> flights_of(const std::vector<double>& factor) {
  std::vector<FlightSeries> modes;
  simulation::RandomStream noise(11, "flights");
  for (const double hz : {1.5, 4.2, 7.1, 9.6}) {
    FlightSeries& series = modes.emplace_back();
    for (std::size_t k = 0; k < factor.size(); ++k)
      series.push_back({k, hz * factor[k] * (1.0 + 1e-3 * noise.gaussian()), 1e-3 * hz, 8.0});
  }
  return modes;
}

TEST(ContradictingFlights, NamesTheWrongClockAmongTwoGoodOnes) {
  for (std::size_t wrong = 0; wrong < 3; ++wrong) {
    std::vector<double> factor(3, 1.0);
    factor[wrong] = 1.02;
    const auto found = contradicting_flights(flights_of(factor), days(3));
    ASSERT_EQ(found.size(), 1U) << wrong;
    EXPECT_EQ(found[0].flight, wrong);
    EXPECT_NEAR(found[0].share, 0.02, 4.0 * found[0].std);
    EXPECT_TRUE(found[0].is_common);
  }
}

TEST(ContradictingFlights, GoodFlightsAndAChangeOfTheStructureAreLeftAlone) {
  EXPECT_TRUE(contradicting_flights(flights_of(std::vector<double>(8, 1.0)), days(8)).empty());
  EXPECT_TRUE(contradicting_flights(flights_of({1, 1, 1, 1, 1, 0.97, 0.97, 0.97}), days(8)).empty());
  EXPECT_TRUE(contradicting_flights(flights_of({1.0, 1.1}), days(2)).empty());
  EXPECT_TRUE(contradicting_flights({}, days(5)).empty());
}

TEST(ContradictingFlights, WeatherThatMovesAllModesIsNone) {
  Conditions conditions = days(12);
  std::vector<double> factor;
  for (std::size_t k = 0; k < 12; ++k) {
    conditions.temperature_c.push_back(k == 7 ? 30.0 : 10.0 + static_cast<double>(k % 4));
    factor.push_back(1.0 - 5e-4 * (conditions.temperature_c.back() - 10.0));
  }
  EXPECT_TRUE(contradicting_flights(flights_of(factor), conditions).empty());
  factor[3] *= 1.02;
  const auto found = contradicting_flights(flights_of(factor), conditions);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].flight, 3U);
}

}  // namespace
}  // namespace core::monitoring

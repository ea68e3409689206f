#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "core/spectrum/welch_cpsd.h"
#include "tests/support/places.h"

namespace core {
namespace {

constexpr double kBar = 1e-10;
// Deviations are relative to at least this share of the pair's peak, because detrending leaves rounding noise in bin 0.
constexpr double kFloor = 1e-4;

nlohmann::json golden() {
  std::ifstream file(tests::source_path("tests/golden/welch_golden.json"));
  return nlohmann::json::parse(file);
}

// One-sided density of a pair, scaled as in scipy.
std::complex<double> density(const CpsdSums& sums, int bin, int pair) {
  const double sides = bin == 0 || bin == sums.n_fft / 2 ? 1.0 : 2.0;
  const auto at =
      static_cast<std::size_t>(bin) * static_cast<std::size_t>(sums.n_pairs()) + static_cast<std::size_t>(pair);
  return sides * sums.data_sum[at] / (sums.rate_hz * sums.window_power * static_cast<double>(sums.n_segments));
}

WelchCpsd run(const nlohmann::json& all, const nlohmann::json& item) {
  const auto channels = all["channels"].get<std::vector<std::vector<double>>>();
  WelchConfig config;
  config.n_channels = static_cast<int>(channels.size());
  config.segment = item["segment"];
  config.overlap = item["overlap"];
  config.window = window_kind(item["window"].get<std::string>()).value();
  config.rate_hz = all["rate_hz"];
  WelchCpsd welch(config);
  const std::vector<std::uint8_t> seen(channels.size(), 1);
  std::vector<double> sample(channels.size());
  for (std::size_t t = 0; t < channels.front().size(); ++t) {
    for (std::size_t c = 0; c < channels.size(); ++c) sample[c] = channels[c][t];
    welch.push(sample, seen);
  }
  return welch;
}

double worst_deviation(const CpsdSums& sums, const nlohmann::json& expected, int pair) {
  const auto re = expected["re"].get<std::vector<double>>();
  const auto im = expected["im"].get<std::vector<double>>();
  EXPECT_EQ(static_cast<int>(re.size()), sums.n_bins());
  double peak = 0.0;
  for (std::size_t k = 0; k < re.size(); ++k) peak = std::max(peak, std::hypot(re[k], im[k]));
  double worst = 0.0;
  for (std::size_t k = 0; k < re.size(); ++k) {
    const std::complex<double> value(re[k], im[k]);
    const double off = std::abs(density(sums, static_cast<int>(k), pair) - value);
    worst = std::max(worst, off / std::max(std::abs(value), kFloor * peak));
  }
  return worst;
}

TEST(WelchGolden, EqualsScipyCsd) {
  const nlohmann::json all = golden();
  ASSERT_EQ(all["cases"].size(), 14U);
  double worst = 0.0;
  for (const nlohmann::json& item : all["cases"]) {
    SCOPED_TRACE(item["window"].get<std::string>() + " " + item["segment"].dump() + " overlap " +
                 item["overlap"].dump());
    const WelchCpsd welch = run(all, item);
    ASSERT_EQ(welch.sums().n_fft, item["n_fft"].get<int>());
    ASSERT_EQ(static_cast<int>(item["pairs"].size()), welch.sums().n_pairs());
    for (int pair = 0; pair < welch.sums().n_pairs(); ++pair) {
      const double off = worst_deviation(welch.sums(), item["pairs"][static_cast<std::size_t>(pair)], pair);
      EXPECT_LE(off, kBar) << "pair " << pair;
      worst = std::max(worst, off);
    }
  }
  std::ostringstream text;
  text << worst;
  RecordProperty("worst_relative_deviation", text.str());
}

}  // namespace
}  // namespace core

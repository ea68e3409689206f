#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/spectrum/welch_cpsd.h"

namespace core {
namespace {

// Of the value itself, and of the pair's peak for bins that detrending leaves at rounding noise (bin 0).
constexpr double kRelative = 1e-10;
constexpr double kOfPeak = 1e-14;

nlohmann::json golden() {
  std::ifstream file(HOVERMODAL_SOURCE_DIR "/tests/golden/welch_golden.json");
  return nlohmann::json::parse(file);
}

// One-sided density of a pair, scaled as scipy does.
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

TEST(WelchGolden, EqualsScipyCsd) {
  const nlohmann::json all = golden();
  ASSERT_EQ(all["cases"].size(), 10U);
  for (const nlohmann::json& item : all["cases"]) {
    SCOPED_TRACE(item["window"].get<std::string>() + " " + item["segment"].dump() + " overlap " +
                 item["overlap"].dump());
    const WelchCpsd welch = run(all, item);
    ASSERT_EQ(welch.sums().n_fft, item["n_fft"].get<int>());
    ASSERT_EQ(static_cast<int>(item["pairs"].size()), welch.sums().n_pairs());
    for (int pair = 0; pair < welch.sums().n_pairs(); ++pair) {
      const auto re = item["pairs"][static_cast<std::size_t>(pair)]["re"].get<std::vector<double>>();
      const auto im = item["pairs"][static_cast<std::size_t>(pair)]["im"].get<std::vector<double>>();
      ASSERT_EQ(static_cast<int>(re.size()), welch.sums().n_bins());
      double peak = 0.0;
      for (std::size_t k = 0; k < re.size(); ++k) peak = std::max(peak, std::hypot(re[k], im[k]));
      for (int k = 0; k < welch.sums().n_bins(); ++k) {
        const std::complex<double> expected(re[static_cast<std::size_t>(k)], im[static_cast<std::size_t>(k)]);
        ASSERT_LE(std::abs(density(welch.sums(), k, pair) - expected), kRelative * std::abs(expected) + kOfPeak * peak)
            << "pair " << pair << " bin " << k;
      }
    }
  }
}

}  // namespace
}  // namespace core

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "core/identification/common_drift.h"
#include "core/identification/identifier.h"
#include "core/identification/mode_tracker.h"
#include "core/spectrum/welch_cpsd.h"
#include "drivers/storage/csv.h"
#include "tests/support/measured_data.h"

namespace {

// A steel frame shaken by fans for 240 s: three lasers and an accelerometer at 256 Hz; published frequencies.
constexpr double kRateHz = 32.0;
constexpr std::size_t kDecimation = 8;
constexpr std::array<double, 8> kPublishedHz{1.229, 1.436, 2.100, 4.017, 4.769, 6.683, 7.614, 9.664};
const std::array<const char*, 4> kSetups{"setup_01", "setup_04", "setup_07", "setup_10"};

std::string path_of(const std::string& setup) { return "five_storey_frame/" + setup + ".csv"; }

// Mean of every eight samples. `stretch` > 0 plays the record at increasing speed, by that share at its end: every
// frequency rises by it.
std::vector<std::vector<double>> samples_of(const drivers::SeriesFile& file, double stretch) {
  const auto n = static_cast<double>(file.columns.front().size());
  std::vector<std::vector<double>> out;
  for (std::size_t i = 0;; ++i) {
    std::vector<double> row(file.columns.size());
    for (std::size_t k = 0; k < kDecimation; ++k) {
      const double at = static_cast<double>(kDecimation * i + k);
      const double place = at + stretch * at * at / (2.0 * n);
      const double share = place - std::floor(place);
      if (place + 1.0 >= n) return out;
      const auto j = static_cast<std::size_t>(place);
      for (std::size_t c = 0; c < row.size(); ++c) {
        row[c] += ((1.0 - share) * file.columns[c][j] + share * file.columns[c][j + 1]) / double{kDecimation};
      }
    }
    out.push_back(row);
  }
}

std::vector<core::ModalEstimate> estimates_of(const std::string& setup, double stretch) {
  const drivers::SeriesFile file = drivers::read_series_csv((tests::measured_data_path() / path_of(setup)).string());
  std::vector<core::ChannelInfo> channels(file.columns.size());
  for (std::size_t c = 0; c < channels.size(); ++c) channels[c].name = file.names[c];
  core::WelchConfig welch;
  welch.n_channels = static_cast<int>(channels.size());
  welch.segment = 1024;
  welch.rate_hz = kRateHz;
  core::WelchCpsd cpsd(welch);
  core::IdentifierConfig config;
  config.n_differences = 0;
  const core::Identifier identifier(config, channels);
  core::ModeTracker tracker({.row_delay_s = identifier.undone_delay_s()});
  std::vector<core::ModalEstimate> out;
  const std::vector<std::uint8_t> seen(channels.size(), 1);
  for (const std::vector<double>& row : samples_of(file, stretch)) {
    if (!cpsd.push(row, seen) || cpsd.n_hops() % 2 != 0) continue;
    out.push_back(identifier.identify(cpsd.sums()));
    tracker.update(out.back());
  }
  return out;
}

// The mode nearest a published frequency, within 2 %; nullptr: none.
const core::Mode* mode_near(const core::ModalEstimate& estimate, double frequency_hz) {
  const core::Mode* nearest = nullptr;
  for (const core::Mode& mode : estimate.modes) {
    const double away = std::abs(mode.frequency_hz - frequency_hz);
    if (away > 0.02 * frequency_hz) continue;
    if (nearest == nullptr || away < std::abs(nearest->frequency_hz - frequency_hz)) nearest = &mode;
  }
  return nearest;
}

TEST(ModeTracking, EightMeasuredModesKeepTheirNumbersAndDoNotDrift) {
  SKIP_WITHOUT_MEASURED(path_of(kSetups[0]));
  for (const char* setup : kSetups) {
    const auto estimates = estimates_of(setup, 0.0);
    ASSERT_GE(estimates.size(), 6U);
    for (std::size_t m = 0; m < kPublishedHz.size(); ++m) {
      for (std::size_t k = 1; k < estimates.size(); ++k) {
        const core::Mode* mode = mode_near(estimates[k], kPublishedHz[m]);
        ASSERT_TRUE(mode != nullptr && mode->history) << setup << ", " << kPublishedHz[m] << " Hz, estimate " << k;
        EXPECT_EQ(mode->history->id, m + 1) << setup;
        EXPECT_EQ(mode->history->n_estimates, k + 1) << setup;
        EXPECT_FALSE(mode->history->drifts) << setup << ", " << kPublishedHz[m] << " Hz, estimate " << k;
      }
    }
  }
}

TEST(ModeTracking, MeasuresTheDriftOfARecordPlayedEverFaster) {
  SKIP_WITHOUT_MEASURED(path_of(kSetups[0]));
  for (const double stretch : {0.0, 0.01}) {
    for (const char* setup : kSetups) {
      const auto drift = core::common_drift(estimates_of(setup, stretch).back());
      ASSERT_TRUE(drift) << setup;
      const double truth = stretch / 240.0;
      std::printf("%s played %.0f %% faster: drift %.2f +- %.2f %% in 240 s, from %zu modes\n", setup, 100.0 * stretch,
                  24000.0 * drift->share_per_s, 24000.0 * drift->std_per_s, drift->n_modes);
      EXPECT_GE(drift->n_modes, kPublishedHz.size()) << setup;
      EXPECT_LT(std::abs(drift->share_per_s - truth), 3.0 * drift->std_per_s) << setup;
      EXPECT_EQ(drift->drifts, stretch > 0.0) << setup;
    }
  }
}

}  // namespace

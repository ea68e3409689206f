#include "firmware_app/config/core_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

template <class Work>
std::string config_error(const Work& work) {
  try {
    work();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(CoreConfig, RefusesFrequenciesThatFoldTooOften) {
  EXPECT_NO_THROW(require_searchable(0.0, 25.0));
  EXPECT_NO_THROW(require_searchable(800.0, 25.0));
  EXPECT_THAT(config_error([] { require_searchable(1e6, 25.0); }),
              AllOf(HasSubstr("identification.max_frequency_hz: 1e+06"), HasSubstr("0 .. 800"), HasSubstr("lower it")));
  EXPECT_THROW(require_searchable(std::numeric_limits<double>::quiet_NaN(), 25.0), ConfigError);
}

TEST(CoreConfig, RefusesSpectraThatDoNotFitIntoMemory) {
  SpectrumConfig spectrum;
  spectrum.segment = 512;
  const core::WelchConfig welch = welch_config(spectrum, 7, 25.0);
  const core::CpsdSums sums = core::WelchCpsd::empty_sums(welch);
  const double one = 32.0 * static_cast<double>(sums.data_sum.size() * (1 + sums.blocks.size()));
  EXPECT_DOUBLE_EQ(spectra_bytes(welch), 2.0 * one);
  EXPECT_NO_THROW(require_memory(welch, 1e6, 2'000'000));
  EXPECT_THAT(
      config_error([&] { require_memory(welch, 2e9, 1'000'000'000); }),
      AllOf(HasSubstr("spectrum.segment: 512"), HasSubstr("7 channels"), HasSubstr("2.0 GB"), HasSubstr("1.0 GB")));
}

}  // namespace
}  // namespace app

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

struct StaticRegion {
  AppConfig config;
  core::CameraInfo camera;

  explicit StaticRegion(bool calibrated) {
    camera.width_px = 640;
    camera.height_px = 480;
    camera.rate_hz = 25.0;
    config.regions.resize(2);
    config.regions[1].role = core::RegionRole::kBackground;
    if (calibrated) config.calibration.fx = config.calibration.fy = 700.0;
  }
  [[nodiscard]] std::string words(core::CameraFollowing following) {
    config.scale.following = following;
    return corrections(config, camera).at(0);
  }
};

TEST(CoreConfig, SaysWhichPartOfTheCamerasMotionIsRemoved) {
  using core::CameraFollowing;
  StaticRegion known(true), unknown(false);
  EXPECT_EQ(AppConfig().scale.following, CameraFollowing::kSlow);
  EXPECT_THAT(known.words(CameraFollowing::kSlow), HasSubstr("slower than 1 Hz"));
  EXPECT_THAT(known.words(CameraFollowing::kDistance), AllOf(HasSubstr("scale per frame"), HasSubstr("coherent")));
  EXPECT_THAT(known.words(CameraFollowing::kWhole), HasSubstr("yaw and pitch from the background"));
  EXPECT_EQ(unknown.words(CameraFollowing::kSlow), known.words(CameraFollowing::kDistance));
  EXPECT_THAT(unknown.words(CameraFollowing::kWhole), HasSubstr("no focal length is known"));
  known.config.camera.attitude_file = "attitude.csv";
  EXPECT_THAT(known.words(CameraFollowing::kSlow), HasSubstr("yaw and pitch from the background"));
  known.config.camera.attitude_file.clear();
  known.config.spectrum.witness = false;
  EXPECT_EQ(known.words(CameraFollowing::kSlow), known.words(CameraFollowing::kDistance));
}

}  // namespace
}  // namespace app

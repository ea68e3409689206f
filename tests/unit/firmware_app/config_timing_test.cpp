#include "firmware_app/config/config_timing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace app {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

AppConfig with(double readout_ms, double exposure_ms = 0.0, double rate_hz = 0.0) {
  AppConfig config;
  config.camera.readout_ms = readout_ms;
  config.camera.exposure_ms = exposure_ms;
  config.camera.rate_hz = rate_hz;
  return config;
}

std::string refusal(double readout_ms, double rate_hz) {
  try {
    check_against_rate(with(readout_ms), rate_hz);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ConfigTiming, AReadoutLongerThanAFrameIsRefused) {
  EXPECT_THAT(refusal(1000.0, 25.0),
              AllOf(HasSubstr("camera.readout_ms: 1000 is refused"), HasSubstr("40 ms"), HasSubstr("25 Hz")));
  EXPECT_THAT(refusal(-41.0, 25.0), HasSubstr("is refused"));
  EXPECT_THAT(refusal(26000.0, 25.0), HasSubstr("microseconds? Then it is 26 ms"));
  EXPECT_EQ(refusal(40.0, 25.0), "accepted");
  EXPECT_EQ(refusal(33.3667, 29.97002997), "accepted") << "a rounding";
  EXPECT_EQ(refusal(-26.0, 25.0), "accepted");
}

TEST(ConfigTiming, ValuesThatAreSeldomTrueAreDoubtedWithTheLikelySlip) {
  EXPECT_THAT(doubtful_values(with(26.0, 4.0), 25.0, 25.0, 0.96), IsEmpty());
  EXPECT_THAT(doubtful_values(with(0.026), 25.0, 25.0, 0.0), Contains(HasSubstr("seconds? Then it is 26 ms")));
  EXPECT_THAT(doubtful_values(with(0.0, 0.002), 25.0, 25.0, 0.0), Contains(HasSubstr("seconds? Then it is 2 ms")));
  EXPECT_THAT(doubtful_values(with(0.0, 4000.0), 25.0, 25.0, 0.0),
              Contains(HasSubstr("microseconds? Then it is 4 ms")));
  EXPECT_THAT(doubtful_values(with(0.0), 25.0, 25.0, 0.00096),
              Contains(HasSubstr("metres instead of mm? Then a pixel is 0.96 mm")));
  EXPECT_THAT(doubtful_values(with(0.0), 25.0, 25.0, 960.0), Contains(HasSubstr("micrometres")));
  EXPECT_THAT(doubtful_values(with(0.0, 0.0, 250.0), 250.0, 50.0, 0.0),
              Contains(AllOf(HasSubstr("250"), HasSubstr("container states 50"), HasSubstr("slow motion"))));
}

}  // namespace
}  // namespace app

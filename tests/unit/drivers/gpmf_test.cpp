#include "drivers/camera/recording/gpmf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "drivers/camera/recording/clip_telemetry.h"
#include "tests/support/gpmf_bytes.h"

namespace drivers {
namespace {

using test_support::big_endian;
using test_support::gpmf_item;
using test_support::gpmf_text;
using ::testing::HasSubstr;

std::string refusal(const std::string& bytes) {
  try {
    (void)parse_gpmf(test_support::span_of(bytes));
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "accepted";
}

std::string gyro(const std::string& orientation, std::vector<std::array<double, 3>> rows_rad_s) {
  std::string values;
  for (const auto& row : rows_rad_s) {
    for (const double value : row)
      values += big_endian<std::int16_t>(static_cast<std::int16_t>(std::lround(value * 1000)));
  }
  return gpmf_item("STRM", '\0', 1,
                   gpmf_item("TSMP", 'L', 4, big_endian<std::uint32_t>(7)) +
                       (orientation.empty() ? "" : gpmf_text("ORIN", orientation)) +
                       gpmf_item("SCAL", 's', 2, big_endian<std::int16_t>(1000)) + gpmf_item("GYRO", 's', 6, values));
}

std::string device(const std::string& streams) {
  return gpmf_item("DEVC", '\0', 1, gpmf_text("DVNM", "Made Up") + streams);
}

TEST(Gpmf, ReadsScaledRowsOfEveryStream) {
  const std::string bytes =
      device(gyro("XzY", {{0.5, -0.25, 1.0}, {2.0, 0.0, -1.0}}) +
             gpmf_item("STRM", '\0', 1,
                       gpmf_item("STMP", 'J', 8, big_endian<std::uint64_t>(2'500'000)) +
                           gpmf_item("SHUT", 'f', 4,
                                     big_endian<float>(0.01F) + big_endian<float>(0.02F) + big_endian<float>(0.5F))));
  const GpmfPayload payload = parse_gpmf(test_support::span_of(bytes));
  EXPECT_EQ(payload.device, "Made Up");
  ASSERT_EQ(payload.streams.size(), 2U);
  EXPECT_EQ(payload.streams[0].key, "GYRO");
  EXPECT_EQ(payload.streams[0].n_columns, 3U);
  EXPECT_EQ(payload.streams[0].n_so_far, 7U);
  EXPECT_THAT(payload.streams[0].values, ::testing::ElementsAre(0.5, -0.25, 1.0, 2.0, 0.0, -1.0));
  EXPECT_EQ(payload.streams[0].orientation_in, "XzY");
  EXPECT_EQ(payload.streams[1].key, "SHUT");
  EXPECT_EQ(payload.streams[1].n_rows(), 3U);
  EXPECT_DOUBLE_EQ(payload.streams[1].first_s.value(), 2.5);
}

TEST(Gpmf, EveryCutIsAResultOrARefusalThatNamesThePlace) {
  const std::string bytes = device(gyro("", {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}));
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    const std::string words = refusal(bytes.substr(0, n));
    EXPECT_THAT(words, HasSubstr("byte ")) << n;
  }
  EXPECT_EQ(refusal(bytes), "accepted");
}

TEST(Gpmf, NoKeyNestingOrZerosAreRefused) {
  EXPECT_THAT(refusal(std::string(64, '\0')), HasSubstr("no metadata"));
  EXPECT_THAT(refusal("\x01\x02\x03\x04\x05\x06\x07\x08"), HasSubstr("key of four letters: no GPMF"));
  EXPECT_THAT(refusal(gpmf_text("DVNM", "four") + "\x01\x02\x03\x04\x05\x06\x07\x08"),
              HasSubstr("byte 12: not a key of four letters: damaged"));
  std::string nested = gpmf_text("DVNM", "x");
  for (int i = 0; i < 20; ++i) nested = gpmf_item("DEVC", '\0', 1, nested);
  EXPECT_THAT(refusal(nested), HasSubstr("nested"));
}

TimedPayload payload_of(const std::string& bytes, double t_s) {
  return {t_s, 1.0, parse_gpmf(test_support::span_of(bytes))};
}

// A constant rate about one axis: the attitude is the rotation by rate x time about that axis.
TEST(GpmfTelemetry, IntegratesTheGyroInTheAxesThatTheCameraStates) {
  constexpr std::size_t kRows = 100;
  const std::vector<std::array<double, 3>> rows(kRows, {0.0, 0.3, 0.0});  // second column
  for (const auto& [orientation, axis, sign] :
       {std::tuple{std::string(), 1, 1.0}, {std::string("XzY"), 3, -1.0}, {std::string("YxZ"), 1, -1.0}}) {
    std::vector<TimedPayload> payloads;
    for (int second = 0; second < 3; ++second)
      payloads.push_back(payload_of(device(gyro(orientation, rows)), static_cast<double>(second)));
    const ClipTelemetry telemetry = telemetry_of(payloads);
    ASSERT_EQ(telemetry.attitude.size(), 3 * kRows);
    const core::AttitudeSample& last = telemetry.attitude.back();
    EXPECT_NEAR(last.t_s, 2.99, 1e-9);
    EXPECT_NEAR(last.wxyz[0], std::cos(0.5 * 0.3 * 2.99), 1e-9) << orientation;
    EXPECT_NEAR(last.wxyz[static_cast<std::size_t>(axis)], sign * std::sin(0.5 * 0.3 * 2.99), 1e-9) << orientation;
    EXPECT_EQ(telemetry.attitude_from, "gyro");
  }
}

TEST(GpmfTelemetry, TheCamerasClockGivesTheRateOfFrames) {
  std::vector<TimedPayload> payloads;
  std::string exposures;
  for (int i = 0; i < 30; ++i) exposures += big_endian<float>(i < 15 ? 0.001F : 0.002F);
  for (int second = 0; second < 5; ++second) {
    const auto stamp_us = static_cast<std::uint64_t>(85'000 + second * 30 * 1'001'000 / 30);
    payloads.push_back(payload_of(device(gpmf_item("STRM", '\0', 1,
                                                   gpmf_item("STMP", 'J', 8, big_endian<std::uint64_t>(stamp_us)) +
                                                       gpmf_item("SHUT", 'f', 4, exposures))),
                                  1.001 * second));
  }
  const ClipTelemetry telemetry = telemetry_of(payloads);
  EXPECT_NEAR(telemetry.frame_rate_hz, 30.0 / 1.001, 1e-6);
  EXPECT_LT(telemetry.frame_jitter_s, 1e-6);
  EXPECT_EQ(telemetry.exposure_s.size(), 150U);
  EXPECT_THAT(telemetry_words(telemetry), ::testing::Contains(HasSubstr("exposure changes: 1/1000 s to 1/500 s")));
}

TEST(GpmfTelemetry, AHeadWithoutMeasurementsSaysThatNothingIsTaken) {
  const ClipTelemetry telemetry = telemetry_of(std::vector{payload_of(device(""), 0.0)});
  EXPECT_THAT(telemetry_words(telemetry), ::testing::ElementsAre(HasSubstr("nothing is taken from it")));
}

}  // namespace
}  // namespace drivers

#include "drivers/camera/recording/srt_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/folder_test.h"
#include "tests/support/test_clip.h"

namespace drivers {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string refusal(const std::string& text) {
  try {
    (void)parse_srt(text, "a.SRT");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(SrtFile, OneBlockAFrame) {
  const SrtFile file = parse_srt(
      "\xEF\xBB\xBF"
      "1\n00:00:00,000 --> 00:00:00,040\n<font size=\"36\">FrameCnt : 218, DiffTime : 40ms\n"
      "2019-09-27 10:28:08,438,904\n[iso : 110] [shutter : 1/1250.0] [fnum : 280] [focal_len : 280] </font>\n\n"
      "2\r\n00:01:00,120 --> 00:01:00,160\r\n<font size=\"28\">SrtCnt: 219, DiffTime: 20ms\r\n"
      "2019-09-27 10:28:09.478\r\n[shutter: 1/60.0] [focal_len: 24.00] [dzoom_ratio: 12000, delta:0] "
      "[gb_yaw: -12.5 gb_pitch: -3.0 gb_roll: 0.5]</font>\r\n",
      "a.SRT");
  ASSERT_EQ(file.blocks.size(), 2U);
  const SrtBlock &first = file.blocks[0], &second = file.blocks[1];
  EXPECT_EQ(first.frame, 218U);
  EXPECT_DOUBLE_EQ(first.exposure_s.value(), 1.0 / 1250.0);
  EXPECT_DOUBLE_EQ(first.focal_length.value(), 280.0);
  EXPECT_FALSE(first.zoom.has_value());
  EXPECT_FALSE(first.gimbal_deg.has_value());
  EXPECT_EQ(second.frame, 219U);
  EXPECT_DOUBLE_EQ(second.cue_s.value(), 60.12);
  EXPECT_DOUBLE_EQ(second.zoom.value(), 1.2);
  EXPECT_EQ(second.gimbal_deg.value(), (std::array{0.5, -3.0, -12.5}));
  EXPECT_NEAR(second.clock_s.value() - first.clock_s.value(), 1.039096, 1e-6);
  EXPECT_DOUBLE_EQ(file.clock_tick_s, 1e-6);
}

TEST(SrtFile, OneBlockASecondOfOlderCameras) {
  const SrtFile phantom = parse_srt(
      "1\n00:00:01,000 --> 00:00:02,000\nHOME(149.0251,-20.2532) 2017.8.5 14:11:51\n"
      "GPS(149.0251,-20.2533,16) Hb:1.9 Hs:1.9\nISO:100 TV:60 EV: 0 IR:F2.8\n",
      "a.SRT");
  EXPECT_DOUBLE_EQ(phantom.blocks.at(0).exposure_s.value(), 1.0 / 60.0);
  EXPECT_DOUBLE_EQ(phantom.clock_tick_s, 1.0);
  const SrtFile mavic = parse_srt("1\n00:00:01,000 --> 00:00:02,000\nISO:100 Shutter:400 EV:-1/3 Fnum:F2.8\n", "a.SRT");
  EXPECT_DOUBLE_EQ(mavic.blocks.at(0).exposure_s.value(), 1.0 / 400.0);
  const SrtFile rtk = parse_srt(
      "1\n00:15:04,904 --> 00:15:05,905\nF/5.6, SS 400, ISO 100, EV +0.7, D 153.32m, H.S 1.84m/s, "
      "F.PRY (-8.9\xC2\xB0, 2.9\xC2\xB0, -75.0\xC2\xB0), G.PRY (-27.3\xC2\xB0, 0.5\xC2\xB0, -76.0\xC2\xB0)\n",
      "a.SRT");
  EXPECT_DOUBLE_EQ(rtk.blocks.at(0).cue_s.value(), 904.904);
  EXPECT_DOUBLE_EQ(rtk.blocks.at(0).exposure_s.value(), 1.0 / 400.0);
  EXPECT_EQ(rtk.blocks.at(0).gimbal_deg.value(), (std::array{0.5, -27.3, -76.0}));
}

TEST(SrtFile, ADayEndsWithoutAJumpOfTheClock) {
  const SrtFile file =
      parse_srt("1\n2021-12-31 23:59:59.990\n[iso : 1]\n\n2\n2022-01-01 00:00:00.010\n[iso : 1]\n", "a.SRT");
  EXPECT_NEAR(file.blocks.at(1).clock_s.value() - file.blocks.at(0).clock_s.value(), 0.020, 1e-6);
}

TEST(SrtFile, WhatIsNoTelemetryIsRefusedByFileAndLine) {
  EXPECT_THAT(refusal(""), AllOf(HasSubstr("a.SRT:1"), HasSubstr("no block")));
  EXPECT_THAT(refusal("1\n"), AllOf(HasSubstr("a.SRT:1"), HasSubstr("no block")));
  std::string film;
  for (int i = 1; i < 40; ++i) film += std::to_string(i) + "\n00:00:01,000 --> 00:00:02,000\nYou talk to me?\n\n";
  EXPECT_THAT(refusal(film), AllOf(HasSubstr("a.SRT:"), HasSubstr("ordinary subtitles")));
}

TEST(SrtFile, ACutOffBlockKeepsWhatWasRead) {
  const SrtFile file = parse_srt("1\n00:00:01,000 --> 00:00:02,000\nISO:100 Shutter:400 EV:\n\n2\n00:00:0", "a.SRT");
  EXPECT_EQ(file.blocks.size(), 1U);
}

TEST(SrtFile, NumbersThatCannotBeAreLeftOut) {
  const SrtFile file = parse_srt("1\n[iso : 1] [shutter : 1/0.0] [focal_len : -3] [shutter : 1e-400]\n", "a.SRT");
  EXPECT_FALSE(file.blocks.at(0).exposure_s.has_value());
  EXPECT_FALSE(file.blocks.at(0).focal_length.has_value());
}

TEST(SrtFile, IsFoundBesideItsVideoWhateverItsCase) {
  const auto folder = test_support::fresh_folder();
  std::ofstream(folder / "DJI_0001.MP4") << "x";
  EXPECT_EQ(find_srt((folder / "DJI_0001.MP4").string()), "");
  std::ofstream(folder / "DJI_0001.srt") << "1\n";
  EXPECT_EQ(find_srt((folder / "DJI_0001.MP4").string()), (folder / "DJI_0001.srt").string());
}

}  // namespace
}  // namespace drivers

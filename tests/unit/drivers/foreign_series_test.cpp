#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "drivers/storage/csv.h"
#include "drivers/storage/series_format.h"
#include "drivers/storage/text_file.h"
#include "tests/support/folder_test.h"

namespace drivers {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class ForeignSeries : public tests::FolderTest {
 protected:
  [[nodiscard]] SeriesFile read(const std::string& text, const ForeignFormat& format = {}) const {
    return read_foreign_series(file(text), format);
  }
  [[nodiscard]] std::string refusal(const std::string& text, const ForeignFormat& format = {}) const {
    try {
      static_cast<void>(read(text, format));
    } catch (const FileError& error) {
      return error.what();
    }
    return {};
  }

  std::filesystem::path folder_;
};

TEST_F(ForeignSeries, EverySeparatorGivesTheSameTable) {
  for (const char* text :
       {"a,b\n1.5,-2e-3\n3,4\n", "a;b\n1.5;-2e-3\n3;4\n", "a\tb\n1.5\t-2e-3\n3\t4\n", "a b\n1.5   -2e-3\n  3 4\n",
        "a;b\n1,5;-2e-3\n3;4\n", "a\tb\r\n1,5\t-2e-3\r\n3\t4\r\n", "a b\n1,5 -2e-3\n3 4\n", "a,b,\n1.5,-2e-3,\n3,4,\n",
        "% a note\na, b\n\n1.5, -2e-3\n\n3,4"}) {
    const SeriesFile series = read(text);
    EXPECT_THAT(series.names, ElementsAre("a", "b")) << text;
    ASSERT_EQ(series.columns.size(), 2U) << text;
    EXPECT_THAT(series.columns[0], ElementsAre(1.5, 3.0)) << text;
    EXPECT_THAT(series.columns[1], ElementsAre(-2e-3, 4.0)) << text;
    EXPECT_TRUE(series.has_names);
  }
}

TEST_F(ForeignSeries, ATableWithoutNamesIsRecognised) {
  const SeriesFile series = read("1,2,3\n4,5,6\n");
  EXPECT_FALSE(series.has_names);
  EXPECT_THAT(series.names, ElementsAre("c1", "c2", "c3"));
  EXPECT_THAT(series.columns[2], ElementsAre(3.0, 6.0));
  EXPECT_THAT(read("1\n2\n\n3\n").columns[0], ::testing::SizeIs(4));
}

TEST_F(ForeignSeries, MissingAndInfiniteCellsAreNaN) {
  const SeriesFile series = read("a,b\n1,2\n,nan\ninf,-Infinity\nNA,3\n");
  EXPECT_EQ(series.n_not_finite, 2U);
  for (std::size_t row = 1; row < 4; ++row) EXPECT_TRUE(std::isnan(series.columns[0][row]));
  EXPECT_EQ(series.columns[1][3], 3.0);
}

TEST_F(ForeignSeries, AGapBeforeTheFirstSampleIsNoLineOfNames) {
  const SeriesFile series = read("a,b\nnan,nan\n,\n1,2\n");
  EXPECT_THAT(series.names, ElementsAre("a", "b"));
  EXPECT_THAT(series.columns[0], ElementsAre(1.0));
}

TEST_F(ForeignSeries, UnitsComeFromTheNamesAndComments) {
  const SeriesFile series =
      read("# unit: mm\n# rate_hz: 25\nax [m/s^2],vy (mm/s),z_um,top_m_s2,left_m_s,plain\n1,2,3,4,5,6\n");
  EXPECT_THAT(series.units, ElementsAre("m/s^2", "mm/s", "um", "m/s2", "m/s", ""));
  EXPECT_THAT(series.names, ElementsAre("ax", "vy", "z_um", "top_m_s2", "left_m_s", "plain"));
  EXPECT_EQ(series.comments.at("unit"), "mm");
}

TEST_F(ForeignSeries, LabviewMeasurementsKeepUnitsAndRate) {
  const SeriesFile series = read(
      "LabVIEW Measurement\t\nSeparator\tTab\nDecimal_Separator\t,\nX_Columns\tNo\n***End_of_Header***\t\n\t\n"
      "Channels\t2\t\t\nSamples\t2\t2\t\nY_Unit_Label\tg\tNewtons\t\nDelta_X\t2,000000E-5\t2,000000E-5\t\n"
      "***End_of_Header***\t\t\t\nX_Value\tAcceleration\tForce\tComment\n\t-0,012509\t-0,029330\n\t0,000861\t0,"
      "022965\n");
  ASSERT_TRUE(series.rate_hz.has_value());
  EXPECT_NEAR(*series.rate_hz, 50000.0, 1e-6);
  EXPECT_THAT(series.names, ElementsAre("X_Value", "Acceleration", "Force"));
  EXPECT_THAT(series.columns[1], ElementsAre(-0.012509, 0.000861));
  EXPECT_EQ(series.units[1], "g");
}

TEST_F(ForeignSeries, LabviewHeadsWithCommasAreReadAsThoseWithTabs) {
  const SeriesFile series = read(
      "LabVIEW Measurement,\nSeparator,Comma\nDecimal_Separator,.\nX_Columns,One\n***End_of_Header***,\n,\n"
      "Channels,2,,\nSamples,2,2,\nY_Unit_Label,g,Newtons,\nDelta_X,0.001,0.001,\n***End_of_Header***,,,\n"
      "X_Value,Acceleration,Force,Comment\n0.0000000,-0.5,1\n0.0009766,0.25,2\n");
  ASSERT_TRUE(series.rate_hz.has_value());
  EXPECT_NEAR(*series.rate_hz, 1000.0, 1e-9);
  EXPECT_THAT(series.names, ElementsAre("X_Value", "Acceleration", "Force"));
  EXPECT_THAT(series.columns[1], ElementsAre(-0.5, 0.25));
  EXPECT_EQ(series.units[2], "Newtons");
}

TEST_F(ForeignSeries, RefusalsNameTheLine) {
  EXPECT_THAT(refusal("a,b\n1,2\n3\n"), AllOf(HasSubstr("a.csv:3:"), HasSubstr("1 cells instead of 2")));
  EXPECT_THAT(refusal("a,b\n1,2\n3,x\n"), AllOf(HasSubstr("a.csv:3:"), HasSubstr("`x` is no number")));
  EXPECT_THAT(refusal("a,b\n1,1e999\n2,3\n"), HasSubstr("a.csv:"));
  EXPECT_THAT(refusal("some text\nmore text\n1,2\n"), HasSubstr("neither"));
  EXPECT_THAT(refusal("a,2\n1,2\n"), AllOf(HasSubstr("a.csv:2:"), HasSubstr("neither numbers nor names")));
  EXPECT_THAT(refusal("a,a\n1,2\n"), HasSubstr("twice"));
  EXPECT_THAT(refusal("a,b,c\n1,2\n"), HasSubstr("2 cells under 3 names"));
  EXPECT_THAT(refusal("a,b\n"), HasSubstr("no line of numbers"));
  EXPECT_THAT(refusal(""), HasSubstr("no numbers"));
  EXPECT_THAT(refusal("a,b\n1,2\n", {.no_names = true}), AllOf(HasSubstr("a.csv:1:"), HasSubstr("`a,b`")));
  EXPECT_THAT(refusal("t_s,a\n0,1\n0,2\n"), HasSubstr("does not lie after"));
  EXPECT_THAT(refusal("LabVIEW Measurement\nSeparator\tTab\n"), HasSubstr("does not end"));
  EXPECT_THAT(refusal(std::string("\0\1\2", 3)), HasSubstr("NUL"));
}

TEST_F(ForeignSeries, AMillionLinesAreReadWithProgress) {
  std::string text = "a\n";
  for (int k = 0; k < 1'000'000; ++k) text += std::to_string(k % 1000) + "\n";
  int n_told = 0;
  const SeriesFile series = read(text, {.progress = [&](std::uint64_t) { ++n_told; }});
  EXPECT_EQ(series.columns[0].size(), 1'000'000U);
  EXPECT_EQ(n_told, 5);
}

TEST(MotionUnit, KnowsLengthsVelocitiesAndAccelerations) {
  EXPECT_EQ(motion_unit("mm")->n_integrations, 0);
  EXPECT_EQ(motion_unit("mm/s")->n_integrations, 1);
  EXPECT_DOUBLE_EQ(motion_unit("mm/s")->to_si, 1e-3);
  for (const char* unit : {"m/s^2", "m/s2", "m/s\xC2\xB2", "M/S/S", "m / s^2", "m/s**2"}) {
    ASSERT_TRUE(motion_unit(unit).has_value()) << unit;
    EXPECT_EQ(motion_unit(unit)->n_integrations, 2) << unit;
  }
  EXPECT_DOUBLE_EQ(motion_unit("g")->to_si, 9.80665);
  EXPECT_DOUBLE_EQ(motion_unit("\xC2\xB5m")->to_si, 1e-6);
  EXPECT_EQ(motion_unit("px")->to_si, 0.0);
  for (const char* unit : {"", "N", "Newtons", "V", "mV", "ms", "m/h"}) EXPECT_FALSE(motion_unit(unit)) << unit;
}

}  // namespace
}  // namespace drivers

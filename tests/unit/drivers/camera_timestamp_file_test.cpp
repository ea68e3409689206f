#include "drivers/camera/recording/timestamp_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/test_clip.h"

namespace drivers {
namespace {

using test_support::fresh_folder;
using test_support::write_text;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string refusal(const std::string& text) {
  const std::string path = (fresh_folder() / "clip.timestamps.csv").string();
  write_text(path, text);
  try {
    (void)read_timestamp_file(path);
  } catch (const std::runtime_error& thrown) {
    return thrown.what();
  }
  return "accepted";
}

TEST(TimestampFile, ReadsTimesWithCommentsBlankLinesCarriageReturnsAndByteOrderMark) {
  const std::string path = (fresh_folder() / "t.csv").string();
  write_text(path,
             "\xEF\xBB\xBF"
             "frame,t_s\r\n# read off a stopwatch\n0,4.438\r\n\n 1 , 4.5\n2,1e1");
  EXPECT_THAT(read_timestamp_file(path), ElementsAre(4'438'000'000, 4'500'000'000, 10'000'000'000));
}

TEST(TimestampFile, NamesFileLineAndValueOfABadLine) {
  EXPECT_THAT(refusal("frame,t_s\n0,0\n1,x7\n"), AllOf(HasSubstr("clip.timestamps.csv:3"), HasSubstr("'1,x7'")));
}

TEST(TimestampFile, RefusesAWrongHeader) {
  EXPECT_THAT(refusal("frame,stopwatch_read_s\n1,4.4\n"), AllOf(HasSubstr(":1"), HasSubstr("'frame,t_s'")));
  EXPECT_THAT(refusal("0,0.0\n1,0.1\n"), HasSubstr("header"));
  EXPECT_THAT(refusal(""), HasSubstr("empty"));
  EXPECT_THAT(refusal("frame,t_s\n"), HasSubstr("no time stamp"));
}

TEST(TimestampFile, RefusesRepeatedAndBackwardTimes) {
  EXPECT_THAT(refusal("frame,t_s\n0,1\n1,2\n2,2\n"), AllOf(HasSubstr(":4"), HasSubstr("repeats")));
  EXPECT_THAT(refusal("frame,t_s\n0,1\n1,2\n2,1.5\n"), AllOf(HasSubstr(":4"), HasSubstr("backward")));
  EXPECT_THAT(refusal("frame,t_s\n0,1\n1,1.0000000001\n"), HasSubstr("repeats"));  // the same nanosecond
}

TEST(TimestampFile, RefusesWhatIsNotAFiniteTime) {
  for (const char* value : {"nan", "inf", "-inf", "1e300", "", "1.5s", "0x10", "1,2", "1e19"}) {
    EXPECT_THAT(refusal(std::string("frame,t_s\n0,") + value + "\n"), HasSubstr("finite number")) << value;
  }
}

TEST(TimestampFile, RefusesFramesThatDoNotCountFromZero) {
  EXPECT_THAT(refusal("frame,t_s\n1,0\n2,1\n"), AllOf(HasSubstr(":2"), HasSubstr("expected frame 0")));
  EXPECT_THAT(refusal("frame,t_s\n0,0\n2,1\n"), HasSubstr("expected frame 1"));
  EXPECT_THAT(refusal("frame,t_s\n0,0\n-1,1\n"), HasSubstr("expected frame 1"));
  EXPECT_THAT(refusal("frame,t_s\n0\n"), HasSubstr("two fields"));
}

TEST(TimestampFile, ShowsBinaryRubbishHarmlessly) {
  EXPECT_THAT(refusal(std::string(5000, '\x1b')), AllOf(HasSubstr("'????"), HasSubstr("...'")));
}

TEST(TimestampFile, IsFoundBesideAVideoAndInOrBesideAFolder) {
  const auto folder = fresh_folder();
  write_text(folder / "clip.mp4", "x");
  std::filesystem::create_directories(folder / "images");
  EXPECT_EQ(find_timestamp_file((folder / "clip.mp4").string()), "");
  EXPECT_EQ(find_timestamp_file((folder / "images").string()), "");
  write_text(folder / "clip.timestamps.csv", "");
  write_text(folder / "images.timestamps.csv", "");
  EXPECT_EQ(find_timestamp_file((folder / "clip.mp4").string()), (folder / "clip.timestamps.csv").string());
  EXPECT_EQ(find_timestamp_file((folder / "images").string() + "/"), (folder / "images.timestamps.csv").string());
  write_text(folder / "images" / "timestamps.csv", "");
  EXPECT_THROW((void)find_timestamp_file((folder / "images").string()), std::runtime_error);
  std::filesystem::remove(folder / "images.timestamps.csv");
  EXPECT_EQ(find_timestamp_file((folder / "images").string()), (folder / "images" / "timestamps.csv").string());
}

TEST(TimestampFile, MeanRateIsIntervalsOverSpan) {
  EXPECT_DOUBLE_EQ(mean_rate_hz({1'000'000'000, 1'100'000'000, 1'500'000'000}), 4.0);
}

}  // namespace
}  // namespace drivers

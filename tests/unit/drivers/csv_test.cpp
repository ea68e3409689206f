#include "drivers/storage/csv.h"
#include "drivers/storage/tracks_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "drivers/storage/csv_lines.h"
#include "drivers/storage/csv_writer.h"
#include "drivers/storage/text_file.h"
#include "tests/support/folder_test.h"
#include "tests/support/track_frames.h"

namespace drivers {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kTracks = R"(# hovermodal tracks, version 1
# image_size_px: 640 x 480
# rate_hz: 25
# readout_ms: -12.5
# readout_direction: left
# exposure_ms: 4
# frame_count: unknown
# regions: base,roof
frame,t_s,point,region,u_px,v_px,sigma_px
3,0.120000000,7,roof,10.5000,20.2500,0.05000
3,0.120000000,2,base,11.0000,21.0000,0.02000
5,0.200000001,7,roof,10.6000,20.3000,0.05000
)";

class CsvTest : public tests::FolderTest {
 protected:
  [[nodiscard]] std::string tracks_refusal(const std::string& text) const {
    try {
      static_cast<void>(read_tracks_csv(file(text)));
    } catch (const FileError& error) {
      return error.what();
    }
    return {};
  }
  [[nodiscard]] std::string series_refusal(const std::string& text) const {
    try {
      static_cast<void>(read_series_csv(file(text)));
    } catch (const FileError& error) {
      return error.what();
    }
    return {};
  }
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST_F(CsvTest, ReadsTracksWithTheirHeader) {
  const TracksFile tracks = read_tracks_csv(file(kTracks));
  EXPECT_EQ(tracks.camera.width_px, 640);
  EXPECT_EQ(tracks.camera.height_px, 480);
  EXPECT_EQ(tracks.camera.rate_hz, 25.0);
  EXPECT_EQ(tracks.camera.readout_ns, -12'500'000);
  EXPECT_EQ(tracks.camera.readout_direction, core::ReadoutDirection::kLeft);
  EXPECT_EQ(tracks.camera.exposure_ns, 4'000'000);
  EXPECT_EQ(tracks.camera.frame_count, 0U);
  EXPECT_THAT(tracks.region_names, ElementsAre("base", "roof"));
  const std::vector<core::TrackFrame> frames = tests::frames_of(tracks);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(tracks.n_frames, 2U);
  EXPECT_EQ(tracks.first.points.size(), 2U);
  EXPECT_EQ(tracks.last_sequence, 5U);
  EXPECT_EQ(frames[0].sequence, 3U);
  EXPECT_EQ(frames[0].t_start_ns, 120'000'000);
  EXPECT_FALSE(frames[0].gap_before);
  ASSERT_EQ(frames[0].points.size(), 2U);
  EXPECT_EQ(frames[0].points[0].id, 7U);
  EXPECT_EQ(frames[0].points[0].region, 1U);
  EXPECT_EQ(frames[0].points[1].v_px, 21.0);
  EXPECT_TRUE(frames[0].points[1].seen);
  EXPECT_EQ(frames[1].t_start_ns, 200'000'001);
  EXPECT_TRUE(frames[1].gap_before);
}

TEST_F(CsvTest, TakesWindowsLineEndsAndAMissingLastLineEnd) {
  std::string text;
  for (const char c : std::string(kTracks)) text += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_EQ(read_tracks_csv(file(text.substr(0, text.size() - 2))).n_frames, 2U);
}

TEST_F(CsvTest, TracksThatChangeBetweenTwoPassesAreRefused) {
  const TracksFile tracks = read_tracks_csv(file(kTracks));
  (void)file(replaced(replaced(kTracks, "# regions: base,roof\n", ""), "7,roof", "7,attic"));
  TracksPass pass(tracks);
  core::TrackFrame frame;
  EXPECT_THROW(static_cast<void>(pass.next(frame)), FileError);
}

TEST_F(CsvTest, RefusesBrokenTracks) {
  const auto with = [&](const char* from, const char* to) { return tracks_refusal(replaced(kTracks, from, to)); };
  EXPECT_THAT(with("20.2500,0.05000", "20.2500"), AllOf(HasSubstr("a.csv:10: "), HasSubstr("6 cells instead of 7")));
  EXPECT_THAT(with("20.2500", "x"), AllOf(HasSubstr("a.csv:10: "), HasSubstr("v_px: `x`")));
  EXPECT_THAT(with("20.2500", "nan"), HasSubstr("v_px"));
  EXPECT_THAT(with("20.2500", "1e7"), HasSubstr("v_px"));
  EXPECT_THAT(with("0.05000", "-1"), HasSubstr("sigma_px"));
  EXPECT_THAT(with("7,roof", "-7,roof"), HasSubstr("point"));
  EXPECT_THAT(with("7,roof", "4294967296,roof"), HasSubstr("point"));
  EXPECT_THAT(with("2,base", "7,base"), AllOf(HasSubstr("a.csv:11: "), HasSubstr("twice")));
  EXPECT_THAT(with("5,0.2", "2,0.2"), AllOf(HasSubstr("a.csv:12: "), HasSubstr("goes back")));
  EXPECT_THAT(with("5,0.2", "5,0.1"), HasSubstr("time"));
  EXPECT_THAT(with("5,0.2", "3,0.2"), HasSubstr("two times"));
  EXPECT_THAT(with("5,0.2", "5,1e5"), HasSubstr("t_s"));
  EXPECT_THAT(with("5,0.2", "5.5,0.2"), HasSubstr("frame"));
  EXPECT_THAT(with("frame,t_s", "frame,time"), HasSubstr("expected the header"));
  EXPECT_THAT(with("# rate_hz: 25\n", ""), HasSubstr("rate_hz"));
  EXPECT_THAT(with("# rate_hz: 25", "# rate_hz: nan"), HasSubstr("rate_hz"));
  EXPECT_THAT(with("640 x 480", "0 x 480"), HasSubstr("image width"));
  EXPECT_THAT(with("640 x 480", "640"), HasSubstr("image_size_px"));
  EXPECT_THAT(with("left", "sideways"), HasSubstr("readout_direction"));
  EXPECT_THAT(tracks_refusal(""), HasSubstr("expected the header"));
  EXPECT_THAT(tracks_refusal(std::string(kTracks).substr(0, std::string(kTracks).find("3,0.12"))),
              HasSubstr("no track"));
  EXPECT_THAT(tracks_refusal(std::string(kTracks) + std::string("6,\0", 3)), HasSubstr("NUL"));
  EXPECT_THAT(tracks_refusal(std::string(kTracks) + std::string(1U << 20U, '7')),
              AllOf(HasSubstr("a.csv:13: "), HasSubstr("longer than 64 KiB")));
}

TEST_F(CsvTest, ReadsSeriesWithEmptyCellsAsNan) {
  const SeriesFile series =
      read_series_csv(file("# unit: mm\n# a note\nt_s,a,\"b\"\n0,1.5,\n0.1,, -2e-3\n0.2,nan,+3\n"));
  EXPECT_THAT(series.names, ElementsAre("t_s", "a", "b"));
  EXPECT_EQ(series.comments.at("unit"), "mm");
  ASSERT_EQ(series.columns.size(), 3U);
  EXPECT_THAT(series.columns[0], ElementsAre(0.0, 0.1, 0.2));
  EXPECT_EQ(series.columns[1][0], 1.5);
  EXPECT_TRUE(std::isnan(series.columns[1][1]));
  EXPECT_TRUE(std::isnan(series.columns[1][2]));
  EXPECT_TRUE(std::isnan(series.columns[2][0]));
  EXPECT_EQ(series.columns[2][1], -0.002);
  EXPECT_EQ(series.columns[2][2], 3.0);
  EXPECT_EQ(series.column("b"), 2);
  EXPECT_EQ(series.column("c"), -1);
}

TEST_F(CsvTest, RefusesBrokenSeries) {
  EXPECT_THAT(series_refusal("a,b\n1,2\n1\n"), AllOf(HasSubstr("a.csv:3: "), HasSubstr("1 cells instead of 2")));
  EXPECT_THAT(series_refusal("a,b\n1,2,3\n"), HasSubstr("3 cells instead of 2"));
  EXPECT_THAT(series_refusal("a,b\n1,two\n"), AllOf(HasSubstr("a.csv:2: "), HasSubstr("b: `two` is no number")));
  EXPECT_THAT(series_refusal("a,b\n1,inf\n"), HasSubstr("b: `inf`"));
  EXPECT_THAT(series_refusal("a,b\n1,1 2\n"), HasSubstr("b: `1 2`"));
  EXPECT_THAT(series_refusal("1,2\n3,4\n"), HasSubstr("names of the columns"));
  EXPECT_THAT(series_refusal("a,a\n3,4\n"), HasSubstr("twice"));
  EXPECT_THAT(series_refusal("a,\n3,4\n"), HasSubstr("name is empty"));
  EXPECT_THAT(series_refusal("a,b\n"), HasSubstr("no row"));
  EXPECT_THAT(series_refusal(""), HasSubstr("no header"));
  EXPECT_THAT(series_refusal("# only\n"), HasSubstr("no header"));
  EXPECT_THAT(series_refusal("frame,a\n2,1\n1,1\n"),
              AllOf(HasSubstr("a.csv:3: "), HasSubstr("frame: 1 does not lie after 2")));
  EXPECT_THAT(series_refusal("t_s,a\n2,1\n2,1\n"), HasSubstr("does not lie after"));
  EXPECT_THAT(series_refusal("t_s,a\n,1\n"), HasSubstr("empty"));
  EXPECT_THAT(series_refusal(std::string("a,b\n1,\0\n", 8)), HasSubstr("NUL"));
  EXPECT_THAT(series_refusal("a,b\n" + std::string(70000, ' ') + "1,2\n"), HasSubstr("longer than"));
  EXPECT_THAT(series_refusal("\x01\xff,b\n1,2\n"), HasSubstr("a column"));
  EXPECT_THROW(static_cast<void>(read_series_csv("/nonexistent.csv")), FileError);
  EXPECT_THROW(static_cast<void>(read_series_csv(folder_.string())), FileError);
  EXPECT_THROW(static_cast<void>(read_tracks_csv("/dev/zero")), FileError);
}

// Lines of every length around the reader's block size are read completely.
TEST_F(CsvTest, KeepsLinesWholeAcrossBlocks) {
  std::string text;
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < 40; ++i) {
    lines.emplace_back((i * 7919) % CsvLines::kMaxLineBytes, static_cast<char>('a' + i % 26));
    text += lines.back() + "\n";
  }
  CsvLines reader(file(text));
  std::string_view line;
  for (const std::string& expected : lines) {
    ASSERT_TRUE(reader.next(line));
    EXPECT_EQ(line, expected);
  }
  EXPECT_FALSE(reader.next(line));
}

TEST(CsvNumbers, SecondsKeepEveryNanosecond) {
  for (const std::int64_t t_ns : {std::int64_t{0}, std::int64_t{1}, std::int64_t{-1}, std::int64_t{123456789012345678},
                                  std::int64_t{-999999999}}) {
    fmt::memory_buffer out;
    append_seconds(out, t_ns);
    std::int64_t back = 7;
    ASSERT_TRUE(parse_seconds_ns(std::string_view(out.data(), out.size()), back));
    EXPECT_EQ(back, t_ns) << std::string_view(out.data(), out.size());
  }
  std::int64_t ignored = 0;
  for (const char* text : {"", "-", ".5", "1e3", "99999999999", "1.2.3", "--1", "1,5", "0x1"})
    EXPECT_FALSE(parse_seconds_ns(text, ignored)) << text;
}

TEST(CsvNumbers, FixedDecimalsAreThoseOfPrintf) {
  const auto text = [](double value, int n_decimals) {
    fmt::memory_buffer out;
    return append_fixed(out, value, n_decimals) ? std::string(out.data(), out.size()) : "refused";
  };
  EXPECT_EQ(text(1234.56784, 4), "1234.5678");
  EXPECT_EQ(text(-0.00001, 4), "0.0000");
  EXPECT_EQ(text(-0.5, 0), "-1");
  EXPECT_EQ(text(0.99999, 4), "1.0000");
  EXPECT_EQ(text(-12.000004, 6), "-12.000004");
  EXPECT_EQ(text(1e9, 4), "refused");
  EXPECT_EQ(text(std::nan(""), 4), "refused");
  EXPECT_EQ(text(-INFINITY, 4), "refused");
}

TEST_F(CsvTest, WriterRenamesOnlyACompleteFile) {
  const std::string path = (folder_ / "out.csv").string();
  std::ofstream(path) << "old";
  {
    CsvWriter writer(path);
    EXPECT_FALSE(std::filesystem::exists(path)) << "an old result stands where this run's is expected";
    append_text(writer.buffer(), "half");
    EXPECT_TRUE(writer.end_line());
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_TRUE(std::filesystem::exists(path + ".partial"));
  CsvWriter writer(path);
  append_text(writer.buffer(), "whole");
  writer.commit();
  EXPECT_EQ(read_text_file(path, 100), "whole");
  EXPECT_FALSE(std::filesystem::exists(path + ".partial"));
}

}  // namespace
}  // namespace drivers

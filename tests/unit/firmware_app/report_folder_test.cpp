#include "firmware_app/report/report_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/run_report_fixture.h"

namespace app {
namespace {

using ::testing::HasSubstr;

class ReportFolderTest : public RunReportTest {
 protected:
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories(fs::path(path(name)).parent_path());
    std::ofstream(path(name)) << text;
  }
  void hand_over(const std::string& text, int keep = 3) const {
    ReportFolder folder(path("r"), keep);
    std::ofstream(folder.in_working("modal.json")) << text;
    folder.hand_over();
  }
};

TEST_F(ReportFolderTest, ARunWithoutAFrameTouchesNothing) {
  write("r/modal.json", "good"), write("r/tracks.csv", "long");
  { const RunReport report = open(); }
  EXPECT_EQ(text_of(path("r/modal.json")), "good");
  EXPECT_EQ(text_of(path("r/tracks.csv")), "long");
  EXPECT_EQ(std::distance(fs::directory_iterator(path("r")), fs::directory_iterator()), 2);
}

TEST_F(ReportFolderTest, AnEndWithoutASampleDoesNotReplaceAReport) {
  write("r/modal.json", "good");
  RunReport report = open();
  report.finish({}, {}, {});
  EXPECT_EQ(text_of(path("r/modal.json")), "good");
}

TEST_F(ReportFolderTest, AReportReplacesTheLastOneAsAWhole) {
  write("r/modal.json", "old"), write("r/loop.json", "old"), write("r/notes.txt", "mine");
  config_.report.tracks = false;
  RunReport report = open();
  EXPECT_TRUE(report.add(sample(0)));
  EXPECT_EQ(text_of(path("r/modal.json")), "old") << "until the new one is complete";
  report.finish(estimate(), {}, {});
  EXPECT_THAT(text_of(path("r/modal.json")), HasSubstr("1.657"));
  EXPECT_EQ(text_of(path("r/report.1/modal.json")), "old");
  EXPECT_EQ(text_of(path("r/report.1/loop.json")), "old");
  EXPECT_FALSE(fs::exists(path("r/loop.json"))) << "of another run";
  EXPECT_EQ(text_of(path("r/notes.txt")), "mine");
  EXPECT_FALSE(fs::exists(path("r/report.partial")));
}

TEST_F(ReportFolderTest, KeepsAsManyAsAsked) {
  for (const char* text : {"1", "2", "3", "4"}) hand_over(text, 2);
  EXPECT_EQ(text_of(path("r/modal.json")), "4");
  EXPECT_EQ(text_of(path("r/report.1/modal.json")), "3");
  EXPECT_EQ(text_of(path("r/report.2/modal.json")), "2");
  EXPECT_FALSE(fs::exists(path("r/report.3")));
  hand_over("5", 0);
  EXPECT_EQ(text_of(path("r/modal.json")), "5");
  EXPECT_EQ(text_of(path("r/report.1/modal.json")), "3") << "kept before, and not removed by a run that keeps none";
}

TEST_F(ReportFolderTest, AKilledRunLeavesTheLastReportAndWhatItWrote) {
  write("r/modal.json", "good"), write("r/report.partial/tracks.csv.partial", "some frames");
  {
    ReportFolder folder(path("r"), 3);
    EXPECT_THAT(folder.remark(), HasSubstr("report.unfinished"));
  }
  EXPECT_EQ(text_of(path("r/modal.json")), "good");
  EXPECT_EQ(text_of(path("r/report.unfinished/tracks.csv.partial")), "some frames");
  write("r/report.partial/tracks.csv.partial", "few");
  { const ReportFolder folder(path("r"), 3); }
  EXPECT_EQ(text_of(path("r/report.unfinished/tracks.csv.partial")), "some frames") << "the larger one stays";
}

TEST_F(ReportFolderTest, AKilledRunLosesTwoSecondsOfItsFilesAtMost) {
  RunReport report = open();
  for (std::uint64_t k = 0; k < 50; ++k) EXPECT_TRUE(report.add(frame(k, 5)) && report.add(sample(k)));
  EXPECT_THAT(text_of(path("r/report.partial/displacements.csv.partial")), HasSubstr("\n49,"));
  EXPECT_THAT(text_of(path("r/report.partial/tracks.csv.partial")), HasSubstr("\n49,"));
}

// A loss of power after each step of the hand-over: the next start completes it.
TEST_F(ReportFolderTest, CompletesAHandOverThatWasInterruptedAtAnyStep) {
  const std::vector<std::vector<std::pair<const char*, const char*>>> states{
      {{"modal.json", "old"}, {"tracks.csv", "old"}, {"report.complete/modal.json", "new"}},
      {{"tracks.csv", "old"}, {"report.replaced/modal.json", "old"}, {"report.complete/modal.json", "new"}},
      {{"report.replaced/modal.json", "old"},
       {"report.replaced/tracks.csv", "old"},
       {"report.placing/modal.json", "new"}},
      {{"report.replaced/modal.json", "old"}, {"report.replaced/tracks.csv", "old"}, {"modal.json", "new"}}};
  for (const auto& state : states) {
    fs::remove_all(path("r"));
    write("r/report.1/modal.json", "older");
    for (const auto& [name, text] : state) write(std::string("r/") + name, text);
    { const ReportFolder folder(path("r"), 3); }
    EXPECT_EQ(text_of(path("r/modal.json")), "new");
    EXPECT_EQ(text_of(path("r/report.1/modal.json")), "old");
    EXPECT_EQ(text_of(path("r/report.2/modal.json")), "older");
    EXPECT_FALSE(fs::exists(path("r/tracks.csv"))) << "the new run has none";
    for (const char* name : {"complete", "placing", "replaced", "partial"})
      EXPECT_FALSE(fs::exists(path(std::string("r/report.") + name))) << name;
  }
}

TEST_F(ReportFolderTest, AFullDiskCostsTheTracksNotTheResult) {
  write("r/modal.json", "old");
  ReportFolder folder(path("r"), 3);
  EXPECT_EQ(fs::file_size(folder.in_working(".reserve")), 4U << 20U);
  folder.free_reserve();
  EXPECT_FALSE(fs::exists(folder.in_working(".reserve")));
}

}  // namespace
}  // namespace app

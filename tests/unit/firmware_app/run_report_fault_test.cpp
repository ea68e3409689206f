#include "firmware_app/report/run_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <limits>

#include "drivers/storage/csv.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/report/modal_json.h"
#include "tests/support/run_report_fixture.h"

namespace app {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(RunReportTest, RefusesFoldersThatCannotBe) {
  std::ofstream(path("file")) << "x";
  EXPECT_THROW((void)open("file"), drivers::FileError);
  EXPECT_THROW((void)open("file/below"), drivers::FileError);
  EXPECT_THROW(RunReport("", config_, camera_, channels_, {}), drivers::FileError);
  EXPECT_THROW(RunReport("/proc/report", config_, camera_, channels_, {}), drivers::FileError);
}

// A limit on the size of files replaces a disk that becomes full half way.
TEST_F(RunReportTest, TellsOnceThatTheDiskIsFullAndKeepsWhatFitted) {
  struct rlimit before {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  RunReport report = open();
  struct rlimit small = before;
  small.rlim_cur = 300000;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  bool failed = false;
  for (std::uint64_t k = 0; k < 2000; ++k) {
    failed = !report.add(frame(k, 20)) || failed;
    EXPECT_TRUE(report.add(sample(k)));
  }
  EXPECT_TRUE(failed);
  EXPECT_GT(report.n_items_lost(), 0U);
  std::string message;
  try {
    report.finish(estimate(), {}, {});
  } catch (const drivers::FileError& error) {
    message = error.what();
  }
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_THAT(message, HasSubstr("tracks.csv: writing failed"));
  EXPECT_EQ(fs::file_size(path("r/tracks.csv.partial")), 300000U);
  EXPECT_FALSE(fs::exists(path("r/tracks.csv")));
  EXPECT_TRUE(fs::exists(path("r/displacements.csv"))) << "the files that did not fail are complete";
  EXPECT_TRUE(fs::exists(path("r/modal.json")));
}

TEST_F(RunReportTest, RefusesBrokenModalJson) {
  const std::string good = modal_json({"paper", {"base", "roof"}, estimate(), {}, {}});
  const auto refusal = [&](const std::string& from, const std::string& to) -> std::string {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    std::ofstream(path("m.json"), std::ios::binary) << text.replace(at, from.size(), to);
    try {
      static_cast<void>(read_modal_json(path("m.json")));
    } catch (const drivers::FileError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_THAT(refusal("\"modes\"", "\"models\""), HasSubstr("m.json: modes"));
  EXPECT_THAT(refusal("\"version\": 1", "\"version\": 2"), HasSubstr("version"));
  EXPECT_THAT(refusal("\"frequency_hz\": 1.657", "\"frequency_hz\": null"), HasSubstr("modes[0].frequency_hz"));
  EXPECT_THAT(refusal("\"frequency_hz\": 1.657", "\"frequency_hz\": \"x\""), HasSubstr("no number"));
  EXPECT_THAT(refusal("[0.1, -0.02]", "[0.1]"), HasSubstr("shape.base"));
  EXPECT_THAT(refusal("\"base\": [", "\"bass\": ["), HasSubstr("rejected[0].shape.bass"));
  EXPECT_THAT(refusal("\"structural\"", "\"nice\""), HasSubstr("`nice` is unknown"));
  EXPECT_THAT(refusal("\"samples\": 1500", "\"samples\": -1"), HasSubstr("samples"));
  EXPECT_THAT(refusal("\"fold_n\": -1", "\"fold_n\": 0.5"), HasSubstr("fold_n"));
  EXPECT_THAT(refusal("\"id\": 2", "\"id\": 0"), HasSubstr("modes[0].history.id"));
  EXPECT_THAT(refusal("\"estimates\": 5", "\"estimates\": 5000000000"), HasSubstr("estimates"));
  EXPECT_THAT(refusal("\"drifts\": true", "\"drifts\": 1"), HasSubstr("drifts"));
  EXPECT_THAT(refusal("\"modes\": [", "\"modes\": [7, "), HasSubstr("modes[0]"));
}

}  // namespace
}  // namespace app

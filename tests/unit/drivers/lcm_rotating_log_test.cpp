#ifdef HOVERMODAL_WITH_LCM
#include "drivers/telemetry/rotating_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "drivers/telemetry/record_folder.h"
#include "tests/support/folder_test.h"

namespace drivers {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using RotatingLogTest = tests::FolderTest;

TEST(RecordFolder, AFileWithTheLastNumberDoesNotStopTheCount) {
  EXPECT_EQ(next_run({}), 1);
  EXPECT_EQ(next_run({{"", 7, 0, 0}, {"", 3, 0, 0}}), 8);
  EXPECT_EQ(next_run({{"", 2, 0, 0}, {"", 99'999'999, 0, 0}}), 3);
  EXPECT_EQ(next_run({{"", 99'999'999, 0, 0}}), 1);
}

TEST(RecordFolder, NamesAreReadBack) { EXPECT_EQ(record_name("a_run0001_000", 7, 2), "a_run0001_000_run0007_002.lcm"); }

// A loss of power while the head is written leaves no file that looks like a record.
TEST_F(RotatingLogTest, AFileHasItsNameWhenItsHeadIsOnTheDisk) {
  RotatingLog log({folder_.string(), 1'000'000, 10'000'000, "HOVERMODAL", {"bridge", 42}});
  const auto names_in_folder = [this] {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) names.push_back(entry.path().filename().string());
    return names;
  };
  log.begin([&](EventLog& part, int /*number*/) {
    EXPECT_THAT(names_in_folder(), ElementsAre("bridge_run0001_000.lcm.partial"));
    return part.write("HEAD", {}, 0);
  });
  EXPECT_THAT(names_in_folder(), ElementsAre("bridge_run0001_000.lcm"));
  EXPECT_GT(fs::file_size(log.path()), 0U);
}

}  // namespace
}  // namespace drivers
#endif

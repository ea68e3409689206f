#include "drivers/storage/folder_claim.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "drivers/storage/text_file.h"

namespace drivers {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

class FolderClaimTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) / "folder_claim_test" /
              ::testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
  }
  // Another process that holds the folder until close() of the pipe.
  void hold_elsewhere() {
    ASSERT_EQ(::pipe(until_), 0);
    int ready[2] = {-1, -1};
    ASSERT_EQ(::pipe(ready), 0);
    other_ = ::fork();
    if (other_ == 0) {
      ::close(until_[1]);
      char byte = 0;
      try {
        const auto claim = FolderClaim::take(folder_.string(), "report.directory");
        if (::write(ready[1], "x", 1) != 1 || ::read(until_[0], &byte, 1) < 0) ::_exit(1);
      } catch (...) {
        ::_exit(2);
      }
      ::_exit(0);
    }
    char byte = 0;
    ASSERT_EQ(::read(ready[0], &byte, 1), 1);
    ::close(ready[0]), ::close(ready[1]);
  }
  void release_elsewhere() {
    ::close(until_[1]), ::close(until_[0]);
    int status = 0;
    ASSERT_EQ(::waitpid(other_, &status, 0), other_);
  }
  fs::path folder_;
  pid_t other_ = 0;
  int until_[2] = {-1, -1};
};

TEST_F(FolderClaimTest, NamesTheOtherProcessAndTheRemedy) {
  hold_elsewhere();
  try {
    (void)FolderClaim::take(folder_.string(), "state.directory");
    ADD_FAILURE() << "two owners";
  } catch (const FolderInUse& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("state.directory"), HasSubstr("process " + std::to_string(other_)),
                                    HasSubstr("name another folder")));
  }
  release_elsewhere();
  EXPECT_NO_THROW((void)FolderClaim::take(folder_.string(), "state.directory"));
}

TEST_F(FolderClaimTest, OneProcessMayClaimAFolderForSeveralPurposes) {
  const auto first = FolderClaim::take(folder_.string(), "report.directory");
  const auto second = FolderClaim::take(folder_.string() + "/.", "record.directory");
  EXPECT_EQ(first, second);
}

TEST_F(FolderClaimTest, LeavesNothingInTheFolder) {
  (void)FolderClaim::take(folder_.string(), "report.directory");
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(FolderClaimTest, RefusesWhatIsNoFolder) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "file") << "x";
  EXPECT_THROW((void)FolderClaim::take((folder_ / "file").string(), "state.directory"), FileError);
  EXPECT_THROW((void)FolderClaim::take("", "state.directory"), FileError);
  EXPECT_THROW((void)FolderClaim::take("/proc/none", "state.directory"), FileError);
}

}  // namespace
}  // namespace drivers

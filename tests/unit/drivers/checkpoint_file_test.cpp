#include "drivers/storage/checkpoint_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <csignal>

#include <random>

#include "tests/support/test_clip.h"

namespace drivers {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::vector<std::uint8_t> some_bytes(std::size_t n, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  std::vector<std::uint8_t> bytes(n);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

TEST(CheckpointFile, ReadsBackWhatWasWrittenLast) {
  const std::string path = (test_support::fresh_folder() / "state").string();
  EXPECT_FALSE(read_checkpoint(path).exists);
  for (const std::size_t n : {0U, 1U, 7U, 8U, 100'003U}) {
    EXPECT_EQ(write_checkpoint(path, some_bytes(n, n)), "");
    const CheckpointRead read = read_checkpoint(path);
    EXPECT_TRUE(read.exists);
    EXPECT_EQ(read.refused, "");
    EXPECT_EQ(read.bytes, some_bytes(n, n));
  }
  EXPECT_FALSE(fs::exists(path + ".partial"));
}

TEST(CheckpointFile, APathThatCannotBeLookedAtIsRefusedNotTakenForAbsent) {
  const fs::path path = test_support::fresh_folder() / "state";
  fs::create_symlink("state", path);  // a link to itself
  const CheckpointRead read = read_checkpoint(path.string());
  EXPECT_TRUE(read.exists);
  EXPECT_THAT(read.refused, HasSubstr(path.string()));
}

TEST(CheckpointFile, RefusesEveryTruncationAndEveryFlippedBit) {
  const fs::path path = test_support::fresh_folder() / "state";
  ASSERT_EQ(write_checkpoint(path.string(), some_bytes(61)), "");
  const std::string whole = test_support::read_bytes(path);
  for (std::size_t n = 0; n < whole.size(); ++n) {
    test_support::write_text(path, whole.substr(0, n));
    EXPECT_NE(read_checkpoint(path.string()).refused, "") << n;
  }
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string damaged = whole;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
    test_support::write_text(path, damaged);
    EXPECT_NE(read_checkpoint(path.string()).refused, "") << bit;
  }
  test_support::write_text(path, whole + "x");
  EXPECT_THAT(read_checkpoint(path.string()).refused, HasSubstr("bytes long"));
}

TEST(CheckpointFile, NamesTheVersionOfAnotherRelease) {
  const fs::path path = test_support::fresh_folder() / "state";
  ASSERT_EQ(write_checkpoint(path.string(), some_bytes(10)), "");
  std::string other = test_support::read_bytes(path);
  other[8] = 99;
  test_support::write_text(path, other);
  EXPECT_THAT(read_checkpoint(path.string()).refused, HasSubstr("version is 99"));
}

TEST(CheckpointFile, AFullDiskKeepsTheStateBeforeIt) {
  const fs::path path = test_support::fresh_folder() / "state";
  ASSERT_EQ(write_checkpoint(path.string(), some_bytes(1000)), "");
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{4096, before.rlim_max};  // a file size limit instead of a full disk: write() fails half way
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string refused = write_checkpoint(path.string(), some_bytes(100'000));
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_THAT(refused, HasSubstr("state.partial: "));
  EXPECT_EQ(read_checkpoint(path.string()).bytes, some_bytes(1000));
  EXPECT_FALSE(fs::exists(path.string() + ".partial")) << "the room is given back";
}

TEST(CheckpointFile, AFolderThatIsNotThereOrAFileInItsPlaceIsToldNotThrown) {
  const fs::path folder = test_support::fresh_folder();
  EXPECT_THAT(write_checkpoint((folder / "nowhere" / "state").string(), some_bytes(10)), HasSubstr("No such file"));
  fs::create_directories(folder / "state");
  EXPECT_NE(write_checkpoint((folder / "state").string(), some_bytes(10)), "");
  EXPECT_NE(read_checkpoint((folder / "state").string()).refused, "");
}

TEST(CheckpointFile, KnowsTheBoot) {
  EXPECT_EQ(boot_id().size(), 36U);
  EXPECT_EQ(boot_id(), boot_id());
}

}  // namespace
}  // namespace drivers

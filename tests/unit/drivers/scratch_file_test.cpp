#include "drivers/storage/scratch_file.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>

namespace drivers {
namespace {

namespace fs = std::filesystem;

std::array<std::byte, 4> bytes_of(int first) {
  std::array<std::byte, 4> out{};
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<std::byte>(first + static_cast<int>(i));
  return out;
}

TEST(ScratchFile, GivesBackWhatWasWrittenAnywhere) {
  const std::string folder = ::testing::TempDir() + "scratch_file";
  fs::create_directories(folder);
  std::optional<ScratchFile> file = ScratchFile::in(folder);
  ASSERT_TRUE(file);
  EXPECT_TRUE(file->write(1000, bytes_of(7)));
  EXPECT_TRUE(file->write(0, bytes_of(1)));
  std::array<std::byte, 4> read{};
  EXPECT_TRUE(file->read(1000, read));
  EXPECT_EQ(read, bytes_of(7));
  EXPECT_TRUE(file->read(0, read));
  EXPECT_EQ(read, bytes_of(1));
  EXPECT_FALSE(file->read(1002, read)) << "beyond the end";
  EXPECT_TRUE(fs::is_empty(folder)) << "it has no name";
}

TEST(ScratchFile, NeedsAFolder) {
  EXPECT_FALSE(ScratchFile::in(""));
  EXPECT_FALSE(ScratchFile::in("/nowhere/at/all"));
}

}  // namespace
}  // namespace drivers

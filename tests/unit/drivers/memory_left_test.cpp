#include "drivers/host/memory_left.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include "tests/support/test_clip.h"

namespace drivers {
namespace {

namespace fs = std::filesystem;

void set(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

TEST(MemoryLeft, IsTheLeastOfComputerAndControlGroups) {
  const fs::path root = test_support::fresh_folder();
  set(root / "proc/meminfo", "MemTotal: 9000 kB\nMemFree: 1 kB\nMemAvailable:    5000 kB\n");
  EXPECT_EQ(memory_left(root.string()), 5000U * 1024);
  set(root / "proc/self/cgroup", "0::/system.slice/hovermodald.service\n");
  set(root / "sys/fs/cgroup/system.slice/hovermodald.service/memory.max", "max\n");
  set(root / "sys/fs/cgroup/system.slice/hovermodald.service/memory.current", "10\n");
  EXPECT_EQ(memory_left(root.string()), 5000U * 1024) << "no limit";
  set(root / "sys/fs/cgroup/system.slice/memory.max", "1000\n");
  set(root / "sys/fs/cgroup/system.slice/memory.current", "400\n");
  EXPECT_EQ(memory_left(root.string()), 600U) << "of a level above";
}

TEST(MemoryLeft, UnknownIsNoRefusal) {
  EXPECT_EQ(memory_left(test_support::fresh_folder().string()), std::numeric_limits<std::uint64_t>::max());
}

}  // namespace
}  // namespace drivers

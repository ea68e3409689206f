#include "drivers/telemetry/disk_sync.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <thread>

#include "tests/support/test_clip.h"

namespace drivers {
namespace {

using namespace std::chrono_literals;

bool comes_to(const DiskSync& sync, std::uint64_t n) {
  for (int i = 0; i < 3000 && sync.n_done() < n; ++i) std::this_thread::sleep_for(1ms);
  return sync.n_done() == n;
}

int a_file() { return ::open((test_support::fresh_folder() / "file").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644); }

TEST(DiskSync, WorksOnAFileThatIsClosedMeanwhile) {
  DiskSync sync(0ms);
  for (std::uint64_t n = 1; n <= 20; ++n) {
    const int file = a_file();
    ASSERT_EQ(::write(file, "x", 1), 1);
    sync.request(file);
    ::close(file);
    ASSERT_TRUE(comes_to(sync, n));
  }
  EXPECT_EQ(sync.error(), 0);
}

TEST(DiskSync, DoesNothingWithinThePeriod) {
  DiskSync sync(1h);
  const int file = a_file();
  sync.request(file);
  ASSERT_TRUE(comes_to(sync, 1));
  for (int i = 0; i < 100; ++i) sync.request(file);
  ::close(file);
  EXPECT_EQ(sync.n_done(), 1U);
}

TEST(DiskSync, StatesWhyAFileIsNotSafe) {
  DiskSync sync(0ms);
  sync.request(-1);
  EXPECT_EQ(sync.error(), EBADF);
}

// A pipe cannot be synchronised; a log may be one.
TEST(DiskSync, TakesAPipe) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  DiskSync sync(0ms);
  sync.request(ends[1]);
  ASSERT_TRUE(comes_to(sync, 1));
  EXPECT_EQ(sync.error(), 0);
  ::close(ends[0]), ::close(ends[1]);
}

}  // namespace
}  // namespace drivers

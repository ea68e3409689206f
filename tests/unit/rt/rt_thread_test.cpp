#include "rt/rt_thread.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include <array>
#include <atomic>
#include <string>
#include <system_error>

#include "rt/memory.h"

namespace rt {
namespace {

std::string name_inside(const std::string& asked) {
  std::array<char, 16> name{};
  RtThread thread;
  thread.start({asked, 0, -1}, [&name] { pthread_getname_np(pthread_self(), name.data(), name.size()); });
  thread.join();
  return name.data();
}

int an_allowed_cpu() {
  cpu_set_t cpus;
  CPU_ZERO(&cpus);
  sched_getaffinity(0, sizeof cpus, &cpus);
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(static_cast<std::size_t>(cpu), &cpus)) return cpu;
  }
  return 0;
}

TEST(RtThread, RunsItsBodyOnceAndJoins) {
  std::atomic<int> n_runs{0};
  RtThread thread;
  thread.start({"body", 0, -1}, [&n_runs] { ++n_runs; });
  thread.join();
  EXPECT_EQ(n_runs.load(), 1);
  thread.join();  // nothing left to join
}

TEST(RtThread, MayBeStartedAgain) {
  std::atomic<int> n_runs{0};
  RtThread thread;
  thread.start({"first", 0, -1}, [&n_runs] { ++n_runs; });
  thread.start({"second", 0, -1}, [&n_runs] { ++n_runs; });
  thread.join();
  EXPECT_EQ(n_runs.load(), 2);
}

TEST(RtThread, JoinsInItsDestructor) {
  std::atomic<int> n_runs{0};
  {
    RtThread thread;
    thread.start({"body", 0, -1}, [&n_runs] { ++n_runs; });
  }
  EXPECT_EQ(n_runs.load(), 1);
}

TEST(RtThread, CarriesItsNameCutToWhatTheKernelKeeps) {
  EXPECT_EQ(name_inside("tracking"), "tracking");
  EXPECT_EQ(name_inside("identification of modes"), "identification ");
}

TEST(RtThread, RunsOnTheGivenCpu) {
  const int wanted = an_allowed_cpu();
  int cpu = -1;
  RtThread thread;
  thread.start({"pinned", 0, wanted}, [&cpu] { cpu = sched_getcpu(); });
  thread.join();
  EXPECT_EQ(cpu, wanted);
}

TEST(RtThread, ACpuThatDoesNotExistIsAnErrorInTheStartingThread) {
  RtThread thread;
  EXPECT_THROW(thread.start({"nowhere", 0, CPU_SETSIZE - 1}, [] {}), std::system_error);
  EXPECT_THROW(thread.start({"nowhere", 0, CPU_SETSIZE + 5}, [] {}), std::system_error);
}

TEST(RtThread, APriorityOutOfRangeIsAnErrorThatNamesTheThread) {
  RtThread thread;
  try {
    thread.start({"capture", 1000, -1}, [] {});
    FAIL() << "started";
  } catch (const std::system_error& error) {
    EXPECT_NE(std::string(error.what()).find("capture"), std::string::npos) << error.what();
  }
}

// Granted or refused depends on the machine; in either case the settings must be those requested, or an error here.
TEST(RtThread, APriorityIsGrantedOrRefusedNeverIgnored) {
  int policy = -1;
  sched_param parameter{};
  RtThread thread;
  try {
    thread.start({"priority", 7, -1}, [&] { pthread_getschedparam(pthread_self(), &policy, &parameter); });
    thread.join();
    EXPECT_EQ(policy, SCHED_FIFO);
    EXPECT_EQ(parameter.sched_priority, 7);
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code().value(), EPERM);
  }
}

TEST(RtThread, HasTheStackThatWasAskedForAndTouchesItBeforehand) {
  constexpr std::size_t kStack = 1 << 20;
  std::size_t stack_bytes = 0;
  ThreadConfig config{"stack"};
  config.stack_bytes = kStack;
  config.prefault_bytes = 10 * kStack;  // at most half is touched
  RtThread thread;
  thread.start(config, [&stack_bytes] {
    pthread_attr_t attributes;
    pthread_getattr_np(pthread_self(), &attributes);
    pthread_attr_getstacksize(&attributes, &stack_bytes);
    pthread_attr_destroy(&attributes);
  });
  thread.join();
  EXPECT_GE(stack_bytes, kStack / 2);
  EXPECT_LE(stack_bytes, 2 * kStack);
}

TEST(RtThread, TouchesNoMoreStackThanThereIs) {
  ThreadConfig config{"small"};
  config.stack_bytes = 256 * 1024;
  bool is_back = false;
  RtThread thread;
  thread.start(config, [&is_back] {
    prefault_stack(std::size_t{64} << 20U);
    is_back = true;
  });
  thread.join();
  EXPECT_TRUE(is_back);
}

TEST(RtThread, AStackTooSmallIsAnErrorInTheStartingThread) {
  ThreadConfig config{"tiny"};
  config.stack_bytes = 100;
  RtThread thread;
  EXPECT_THROW(thread.start(config, [] {}), std::system_error);
}

}  // namespace
}  // namespace rt

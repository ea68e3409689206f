#include "drivers/host/host_status.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "tests/support/test_clip.h"

namespace drivers {
namespace {

namespace fs = std::filesystem;

void put(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

TEST(HostStatus, ReadsWhatTheKernelTells) {
  const fs::path root = test_support::fresh_folder();
  put(root / "sys/class/thermal/thermal_zone0/temp", "48000\n");
  put(root / "sys/class/thermal/thermal_zone1/temp", "61500\n");
  put(root / "sys/class/thermal/cooling_device0/type", "thermal-cpufreq-0\n");
  put(root / "sys/class/thermal/cooling_device0/cur_state", "0\n");
  put(root / "sys/devices/system/cpu/cpu0/cpufreq/scaling_cur_freq", "1500000\n");
  put(root / "sys/devices/system/cpu/cpu1/cpufreq/scaling_cur_freq", "1000000\n");
  put(root / "proc/meminfo", "MemTotal: 2000 kB\nMemAvailable:    1000 kB\n");
  put(root / "proc/self/statm", "500 20 3 1 0 100 0\n");
  const core::HostHealth host = read_host_status(root.string(), root.string());
  EXPECT_DOUBLE_EQ(host.cpu_temperature_c, 61.5);
  EXPECT_DOUBLE_EQ(host.cpu_frequency_mhz, 1250.0);
  EXPECT_EQ(host.throttled, 0);
  EXPECT_EQ(host.available_bytes, 1'024'000);
  EXPECT_GE(host.resident_bytes, 20 * 4096);
  EXPECT_GT(host.disk_left_bytes, 0);

  put(root / "sys/class/thermal/cooling_device0/cur_state", "2\n");
  EXPECT_EQ(read_host_status("", root.string()).throttled, 1);
  put(root / "sys/devices/platform/soc/soc:firmware/get_throttled", "0x50000\n");  // in the past only
  EXPECT_EQ(read_host_status("", root.string()).throttled, 0);
  put(root / "sys/devices/platform/soc/soc:firmware/get_throttled", "0x50005\n");
  EXPECT_EQ(read_host_status("", root.string()).throttled, 1);
}

TEST(HostStatus, LeavesUnknownWhatIsNotThereOrNoNumber) {
  const fs::path root = test_support::fresh_folder();
  put(root / "sys/class/thermal/thermal_zone0/temp", "hot\n");
  put(root / "proc/self/statm", "");
  const core::HostHealth host = read_host_status((root / "nowhere").string(), root.string());
  EXPECT_TRUE(std::isnan(host.cpu_temperature_c));
  EXPECT_TRUE(std::isnan(host.cpu_frequency_mhz));
  EXPECT_EQ(host.throttled, -1);
  EXPECT_EQ(host.resident_bytes, -1);
  EXPECT_EQ(host.available_bytes, -1);
  EXPECT_EQ(host.disk_left_bytes, -1);
}

TEST(HostStatus, ReadsWhatThereIs) {
  const fs::path root = test_support::fresh_folder();
  put(root / "proc/meminfo", "MemTotal: 2000 kB\nMemAvailable:    1000 kB\n");
  const HostCapacity host = read_host_capacity(root.string(), root.string());
  EXPECT_EQ(host.memory_bytes, 2'048'000);
  EXPECT_GT(host.disk_bytes, 0);
  const HostCapacity none = read_host_capacity((root / "nowhere").string(), (root / "nowhere").string());
  EXPECT_EQ(none.memory_bytes, -1);
  EXPECT_EQ(none.disk_bytes, -1);
}

TEST(ProcessorLoad, IsTheShareOfWorkSinceTheLastCall) {
  const fs::path root = test_support::fresh_folder();
  put(root / "proc/stat", "cpu  100 0 50 800 50 0 0 0 0 0\ncpu0 1 1 1 1\n");
  ProcessorLoad load(root.string());
  EXPECT_TRUE(std::isnan(load.next()));
  EXPECT_TRUE(std::isnan(load.next())) << "no time has passed";
  put(root / "proc/stat", "cpu  130 0 70 820 80 0 0 0 0 0\n");
  EXPECT_DOUBLE_EQ(load.next(), 0.5);
  put(root / "proc/stat", "nothing");
  EXPECT_TRUE(std::isnan(load.next()));
}

TEST(HostStatus, KnowsThisProcessOnThisComputer) {
  const core::HostHealth host = read_host_status(".");
  EXPECT_GT(host.resident_bytes, 1'000'000);
  EXPECT_GT(host.available_bytes, 0);
  EXPECT_GT(host.disk_left_bytes, 0);
}

}  // namespace
}  // namespace drivers
